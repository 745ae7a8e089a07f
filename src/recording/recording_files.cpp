#include "recording/recording_files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include "edgeslam/input_error.h"
#include "files/file_set.h"
#include "recording/recording_layout.h"

namespace edgeslam {
namespace {

namespace fs = std::filesystem;

std::string writeProblem(const std::string& path, int reason) {
  return path + ": cannot be written: " + std::generic_category().message(reason);
}

// The error of the call that failed, or of an earlier one.
int firstError(int earlier, int result) { return earlier != 0 || result == 0 ? earlier : errno; }

struct WriteOutcome {
  std::size_t written = 0;
  int error = 0;
};

WriteOutcome writeAll(int descriptor, const char* content, std::size_t size) {
  WriteOutcome outcome;
  while (outcome.written < size) {
    const ssize_t written = ::write(descriptor, content + outcome.written, size - outcome.written);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      outcome.error = errno;
      return outcome;
    }
    outcome.written += static_cast<std::size_t>(written);
  }
  return outcome;
}

OpenFile openFolder(const fs::path& path) {
  OpenFile folder(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder.descriptor() < 0)
    throw InputError(path.string() + ": cannot be opened: " + std::generic_category().message(errno));
  return folder;
}

// What is written to a file that somebody removed goes nowhere, and no call says so.
bool isRemoved(const OpenFile& file) {
  struct stat status {};
  return ::fstat(file.descriptor(), &status) == 0 && status.st_nlink == 0;
}

// What a folder holds must outlive a power cut. Some file systems cannot sync folders, which is no reason to fail.
int syncFolder(const OpenFile& folder) {
  if (::fsync(folder.descriptor()) == 0 || errno == EINVAL || errno == ENOSYS) return 0;
  return errno;
}

// The folder and those above it that had to be made for it, outermost last.
std::vector<fs::path> missingFolders(const fs::path& folder) {
  std::vector<fs::path> missing;
  std::error_code ignored;
  for (fs::path path = folder; !path.empty() && !fs::exists(path, ignored); path = path.parent_path()) {
    missing.push_back(path);
  }
  return missing;
}

void checkEmpty(const fs::path& folder) {
  std::error_code error;
  const fs::file_status status = fs::status(folder, error);
  if (!fs::exists(status)) return;
  if (!fs::is_directory(status)) throw InputError(folder.string() + ": is there and no folder");
  const bool empty = fs::is_empty(folder, error);
  if (error) throw InputError(folder.string() + ": cannot be listed: " + error.message());
  if (!empty) throw InputError(folder.string() + ": is not empty; a recording needs a folder of its own");
}

// Throws InputError where something of it fails.
void makeFolder(const fs::path& folder, const std::vector<FileContent>& files, const std::vector<fs::path>& missing) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(folder.string() + ": the folder cannot be made: " + error.message());
  writeFileSet(folder.string(), files);
  int reason = syncFolder(openFolder(folder));
  for (const fs::path& made : missing) {
    const fs::path parent = made.parent_path();
    if (reason == 0) reason = syncFolder(openFolder(parent.empty() ? fs::path(".") : parent));
  }
  if (reason != 0) throw InputError(writeProblem(folder.string(), reason));
}

void removeFolder(const fs::path& folder, const std::vector<FileContent>& files, const std::vector<fs::path>& missing) {
  std::error_code ignored;
  for (const FileContent& file : files) fs::remove(folder / file.name, ignored);
  for (const fs::path& made : missing) fs::remove(made, ignored);
}

}  // namespace

OpenFile::~OpenFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

OpenFile::OpenFile(OpenFile&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

OpenFile& OpenFile::operator=(OpenFile&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

RecordingFiles::RecordingFiles(const std::string& folder, const std::string& camera, const std::string& configuration,
                               const std::string& description, const std::string& mask) {
  checkEmpty(folder);
  std::vector<FileContent> files{{tum_camera_name, camera},
                                 {recording_configuration_name, configuration},
                                 {frame_archive_name, ""},
                                 {tum_list_name, "# timestamp filename\n"},
                                 {recording_decisions_name, ""}};
  if (!mask.empty()) files.push_back({recording_mask_name, mask});
  files.push_back({recording_description_name, description});
  const std::vector<fs::path> missing = missingFolders(folder);
  try {
    makeFolder(folder, files, missing);
    frames_ = openToAppend(folder, frame_archive_name);
    decisions_ = openToAppend(folder, recording_decisions_name);
    list_ = openToAppend(folder, tum_list_name);
  } catch (const InputError&) {
    removeFolder(folder, files, missing);
    throw;
  }
}

RecordingFiles::GrowingFile RecordingFiles::openToAppend(const std::string& folder, const char* name) {
  GrowingFile growing{OpenFile(), folder + "/" + name};
  growing.file = OpenFile(::open(growing.path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC));
  if (growing.file.descriptor() < 0) throw InputError(writeProblem(growing.path, errno));
  growing.length = ::lseek(growing.file.descriptor(), 0, SEEK_END);
  return growing;
}

std::string RecordingFiles::addFrame(const std::string& name, std::int64_t time_ns,
                                     const std::vector<unsigned char>& image) {
  const int archive = frames_.file.descriptor();
  const auto header = archiveHeader(std::string(tum_frames_name) + "/" + name, time_ns, image.size());
  const std::string padding(archivePadding(image.size()), '\0');
  int error = writeAll(archive, header.data(), header.size()).error;
  if (error == 0) error = writeAll(archive, reinterpret_cast<const char*>(image.data()), image.size()).error;
  if (error == 0) error = writeAll(archive, padding.data(), padding.size()).error;
  if (error != 0) {
    return writeProblem(frames_.path, firstError(error, ::ftruncate(archive, frames_.length)));
  }
  const auto bytes = static_cast<off_t>(header.size() + image.size() + padding.size());
  // The disk takes the frame now, so that there is less to wait for later. Whether it did is seen then.
  ::sync_file_range(archive, frames_.length, bytes, SYNC_FILE_RANGE_WRITE);
  frames_.length += bytes;
  return "";
}

std::int64_t RecordingFiles::nextOffset() const { return frames_.length + static_cast<std::int64_t>(archive_block); }

std::string RecordingFiles::confirmFrames() {
  if (confirmed_frames_ == frames_.length) return "";
  if (isRemoved(frames_.file)) return writeProblem(frames_.path, ENOENT);
  if (::fdatasync(frames_.file.descriptor()) != 0) return writeProblem(frames_.path, errno);
  confirmed_frames_ = frames_.length;
  return "";
}

std::string RecordingFiles::appendDecisions(std::string_view lines) { return appendLines(decisions_, lines); }

std::string RecordingFiles::appendList(std::string_view lines) { return appendLines(list_, lines); }

std::string RecordingFiles::appendLines(GrowingFile& file, std::string_view lines) {
  if (lines.empty()) return "";
  const WriteOutcome outcome = writeAll(file.file.descriptor(), lines.data(), lines.size());
  int error = outcome.error;
  std::size_t whole = lines.size();
  if (error != 0) {
    // The last line that fitted only in part would be read as another time stamp or file.
    whole = outcome.written == 0 ? 0 : lines.rfind('\n', outcome.written - 1) + 1;
    error = firstError(error, ::ftruncate(file.file.descriptor(), file.length + static_cast<off_t>(whole)));
  }
  file.length += static_cast<off_t>(whole);
  error = firstError(error, ::fdatasync(file.file.descriptor()));
  return error == 0 ? "" : writeProblem(file.path, error);
}

std::int64_t RecordingFiles::freeBytes() const {
  struct statvfs space {};
  if (::fstatvfs(frames_.file.descriptor(), &space) != 0) return 0;
  return static_cast<std::int64_t>(space.f_bavail) * static_cast<std::int64_t>(space.f_frsize);
}

}  // namespace edgeslam
