#include "dataset/file_set.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>

#include "edgeslam/input_error.h"

namespace edgeslam {
namespace {

namespace fs = std::filesystem;

InputError writeError(const fs::path& path, int error) {
  return InputError(path.string() + ": cannot be written: " + std::generic_category().message(error));
}

// Returns 0, or the errno of what failed.
int writeDescriptor(int descriptor, const std::string& content) {
  std::size_t written = 0;
  while (written < content.size()) {
    const std::size_t block = std::min<std::size_t>(content.size() - written, 1U << 24U);
    const ssize_t count = ::write(descriptor, content.data() + written, block);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    written += static_cast<std::size_t>(count);
  }
  // Some file systems tell of a full disk only when asked to store. A pipe or device cannot be synchronised, which is
  // EINVAL.
  if (::fsync(descriptor) != 0 && errno != EINVAL) return errno;
  return 0;
}

void writeWhole(const fs::path& path, const std::string& content) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (descriptor < 0) throw writeError(path, errno);
  int error = writeDescriptor(descriptor, content);
  if (::close(descriptor) != 0 && error == 0) error = errno;
  if (error != 0) throw writeError(path, error);
}

// The outermost folder that has to be made, or an empty path.
fs::path firstMissing(const fs::path& folder) {
  fs::path missing;
  std::error_code ignored;
  for (fs::path path = folder; !path.empty() && !fs::exists(path, ignored); path = path.parent_path()) missing = path;
  return missing;
}

}  // namespace

void writeFileSet(const std::string& folder_name, const std::vector<FileContent>& files) {
  const fs::path folder = fs::path(folder_name.empty() ? "." : folder_name);
  const fs::path made = firstMissing(folder);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    std::error_code ignored;
    if (!made.empty()) fs::remove_all(made, ignored);
    throw InputError(folder.string() + ": the output folder cannot be made: " + error.message());
  }
  const std::string suffix = ".partial-" + std::to_string(::getpid());
  try {
    for (const FileContent& file : files) {
      if (fs::is_directory(folder / file.name, error)) throw writeError(folder / file.name, EISDIR);
      writeWhole(folder / (file.name + suffix), file.content);
    }
    for (const FileContent& file : files) {
      fs::rename(folder / (file.name + suffix), folder / file.name, error);
      if (error) throw writeError(folder / file.name, error.value());
    }
  } catch (const InputError&) {
    std::error_code ignored;
    for (const FileContent& file : files) fs::remove(folder / (file.name + suffix), ignored);
    if (!made.empty()) fs::remove_all(made, ignored);
    throw;
  }
}

}  // namespace edgeslam
