#include "frames/frame_folder_writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include "edgeslam/input_error.h"
#include "files/atomic_file.h"
#include "files/text_file.h"
#include "frames/calibration_file.h"
#include "frames/frame_encoding.h"
#include "frames/tum_folder.h"

namespace edgeslam {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t sync_interval_ns = 1'000'000'000;  // of the frames' time

std::string reason(int error) { return std::generic_category().message(error); }

// 0 or an errno.
int writeAll(int file, const void* content, std::size_t size) {
  const auto* at = static_cast<const char*>(content);
  while (size > 0) {
    const ssize_t written = write(file, at, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return written == 0 ? EIO : errno;
    at += written;
    size -= static_cast<std::size_t>(written);
  }
  return 0;
}

int writeNewFile(const std::string& path, const std::vector<unsigned char>& content) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0) return errno;
  int error = writeAll(file, content.data(), content.size());
  if (close(file) != 0 && error == 0) error = errno;
  if (error != 0) unlink(path.c_str());
  return error;
}

// Of the disk that the folder is on, or will be.
std::int64_t freeBytes(const std::string& folder) {
  std::error_code error;
  fs::path there = fs::absolute(folder, error);
  while (there.has_relative_path() && !fs::exists(there, error)) there = there.parent_path();
  const fs::space_info space = fs::space(there, error);
  return error ? 0 : static_cast<std::int64_t>(space.available);
}

std::string tooFull(const std::string& folder, std::int64_t kept) {
  return folder + ": the disk has less than " + std::to_string(kept >> 20) + " MiB free";
}

}  // namespace

FrameFolderWriter::FrameFolderWriter(std::string folder, const std::optional<Camera>& camera, const std::string& source,
                                     std::int64_t free_bytes_kept)
    : folder_(std::move(folder)), free_bytes_kept_(free_bytes_kept) {
  std::error_code error;
  if (fs::exists(folder_, error) && (!fs::is_directory(folder_, error) || !fs::is_empty(folder_, error))) {
    throw InputError(folder_ + ": is there already and not an empty folder; give another --output");
  }
  if (freeBytes(folder_) < free_bytes_kept_) throw InputError(tooFull(folder_, free_bytes_kept_));
  fs::create_directories(fs::path(folder_) / tum_frames_name, error);
  if (error) throw InputError(folder_ + ": cannot be made: " + error.message());
  if (camera) writeFileAtomically(folder_ + "/" + tum_camera_name, formatCalibrationFile(*camera));
  const std::string list = folder_ + "/" + tum_list_name;
  list_ = open(list.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0666);
  const std::string heading = "# " + source + "\n# timestamp filename\n";
  const int failed = list_ < 0 ? errno : writeAll(list_, heading.data(), heading.size());
  if (failed != 0) throw InputError(list + ": cannot be written: " + reason(failed));
  syncFolder(fs::path(fs::absolute(folder_, error)).parent_path().string());
}

FrameFolderWriter::~FrameFolderWriter() { close(); }

std::string FrameFolderWriter::fail(const std::string& problem) {
  problem_ = problem;
  return problem_;
}

std::string FrameFolderWriter::write(std::int64_t time_ns, const cv::Mat& grey) {
  if (!problem_.empty()) return problem_;
  if (time_ns < 0 || time_ns <= last_ns_) return fail(folder_ + ": a frame's time stamp is not after the one before");
  if (!encodeFrame(grey, FrameCode::packed, png_)) return fail(folder_ + ": no memory to encode a frame");
  const auto size = static_cast<std::int64_t>(png_.size());
  if (freeBytes(folder_) - size < free_bytes_kept_) return fail(tooFull(folder_, free_bytes_kept_));
  const std::string name = std::string(tum_frames_name) + "/" + tumFrameName(time_ns);
  if (const int error = writeNewFile(folder_ + "/" + name, png_); error != 0) {
    return fail(folder_ + "/" + name + ": cannot be written: " + reason(error));
  }
  waiting_lines_ += formatStamp(time_ns) + " " + name + "\n";
  last_ns_ = time_ns;
  ++frames_;
  bytes_ += size;
  if (synced_ns_ >= 0 && time_ns - synced_ns_ < sync_interval_ns) return "";
  synced_ns_ = time_ns;
  return sync();
}

// The images, which lie on the list's file system, and then the list.
std::string FrameFolderWriter::sync() {
  const std::string lines = std::exchange(waiting_lines_, "");
  int error = syncfs(list_) != 0 ? errno : 0;
  if (error == 0) error = writeAll(list_, lines.data(), lines.size());
  if (error == 0 && fdatasync(list_) != 0) error = errno;
  return error == 0 ? "" : fail(folder_ + "/" + tum_list_name + ": cannot be written: " + reason(error));
}

std::string FrameFolderWriter::close() {
  if (list_ < 0) return problem_;
  const std::string earlier = problem_;
  sync();
  ::close(std::exchange(list_, -1));
  if (!earlier.empty()) problem_ = earlier;
  return problem_;
}

}  // namespace edgeslam
