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
  fs::create_directories(folder / tum_frames_name, error);
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
  fs::remove(folder / tum_frames_name, ignored);
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
                               const std::string& description, const std::string& mask)
    : folder_(folder) {
  checkEmpty(folder);
  std::vector<FileContent> files{{tum_camera_name, camera},
                                 {recording_configuration_name, configuration},
                                 {tum_list_name, "# timestamp filename\n"},
                                 {recording_decisions_name, ""}};
  if (!mask.empty()) files.push_back({recording_mask_name, mask});
  files.push_back({recording_description_name, description});
  const std::vector<fs::path> missing = missingFolders(folder);
  try {
    makeFolder(folder, files, missing);
    frames_folder_ = openFolder(fs::path(folder) / tum_frames_name);
    decisions_ = openLines(folder, recording_decisions_name);
    list_ = openLines(folder, tum_list_name);
  } catch (const InputError&) {
    removeFolder(folder, files, missing);
    throw;
  }
}

RecordingFiles::LineFile RecordingFiles::openLines(const std::string& folder, const char* name) {
  LineFile lines{OpenFile(), folder + "/" + name};
  lines.file = OpenFile(::open(lines.path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC));
  if (lines.file.descriptor() < 0) throw InputError(writeProblem(lines.path, errno));
  lines.length = ::lseek(lines.file.descriptor(), 0, SEEK_END);
  return lines;
}

std::string RecordingFiles::addFrame(const std::string& name, const std::vector<unsigned char>& content) {
  const std::string path = folder_ + "/" + tum_frames_name + "/" + name;
  OpenFile file(::openat(frames_folder_.descriptor(), name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644));
  if (file.descriptor() < 0) return writeProblem(path, errno);
  const int error = writeAll(file.descriptor(), reinterpret_cast<const char*>(content.data()), content.size()).error;
  if (error != 0) {
    ::unlinkat(frames_folder_.descriptor(), name.c_str(), 0);
    return writeProblem(path, error);
  }
  // The disk takes the frame now, so that there is less to wait for later. Whether it did is seen then.
  ::sync_file_range(file.descriptor(), 0, 0, SYNC_FILE_RANGE_WRITE);
  waiting_.push_back({std::move(file), path});
  return "";
}

std::string RecordingFiles::confirmFrames() {
  if (waiting_.empty()) return "";
  const std::vector<WaitingFrame> frames = std::exchange(waiting_, {});
  for (const WaitingFrame& frame : frames) {
    if (::fdatasync(frame.file.descriptor()) != 0) return writeProblem(frame.path, errno);
  }
  const int error = syncFolder(frames_folder_);
  return error == 0 ? "" : writeProblem(folder_ + "/" + tum_frames_name, error);
}

std::string RecordingFiles::appendDecisions(std::string_view lines) { return append(decisions_, lines); }

std::string RecordingFiles::appendList(std::string_view lines) { return append(list_, lines); }

std::string RecordingFiles::append(LineFile& file, std::string_view lines) {
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
  if (::fstatvfs(frames_folder_.descriptor(), &space) != 0) return 0;
  return static_cast<std::int64_t>(space.f_bavail) * static_cast<std::int64_t>(space.f_frsize);
}

}  // namespace edgeslam
