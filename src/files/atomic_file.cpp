#include "files/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include "edgeslam/input_error.h"

namespace edgeslam {
namespace {

std::string temporaryOf(const std::string& path) {
  const std::filesystem::path file(path);
  return (file.parent_path() / ("." + file.filename().string() + ".partial")).string();
}

// Returns 0 or the errno of what failed.
int writeAll(int file, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(file, content.data(), content.size());
    if (written < 0) {
      if (errno == EINTR) continue;
      return errno;
    }
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return ::fsync(file) == 0 ? 0 : errno;
}

// Some file systems know no locks.
bool isLockedByAnother(int file) { return ::flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK; }

// What a power cut left; false where it is another program's, which writes it now.
bool removeLeftover(const std::string& temporary) {
  const int leftover = ::open(temporary.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (leftover < 0 && errno == ENOENT) return true;
  const bool in_use = leftover >= 0 && isLockedByAnother(leftover);
  if (!in_use) ::unlink(temporary.c_str());
  if (leftover >= 0) ::close(leftover);
  return !in_use;
}

// Another program may have taken it for a leftover between its making and its locking.
bool isOurs(int file) {
  struct stat status {};
  return !isLockedByAnother(file) && ::fstat(file, &status) == 0 && status.st_nlink > 0;
}

}  // namespace

PendingFile::PendingFile(const std::string& path, std::string_view content)
    : path_(path), temporary_(temporaryOf(path)) {
  const auto fail = [&path](const char* reason) { throw InputError(path + ": cannot be written: " + reason); };
  if (!removeLeftover(temporary_)) fail("another program is writing it");
  file_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (file_ < 0) fail(std::strerror(errno));
  if (!isOurs(file_)) {
    ::close(file_);
    fail("another program is writing it");
  }
  int reason = writeAll(file_, content);
  // Whatever the umask, others may read it.
  if (reason == 0 && ::fchmod(file_, 0644) != 0) reason = errno;
  if (reason == 0) return;
  ::unlink(temporary_.c_str());
  ::close(file_);
  fail(std::strerror(reason));
}

PendingFile::~PendingFile() {
  if (file_ < 0) return;
  ::unlink(temporary_.c_str());
  ::close(file_);
}

PendingFile::PendingFile(PendingFile&& other) noexcept
    : path_(std::move(other.path_)), temporary_(std::move(other.temporary_)), file_(std::exchange(other.file_, -1)) {}

void PendingFile::takePlace() {
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) {
    throw InputError(path_ + ": cannot be written: " + std::strerror(errno));
  }
  ::close(std::exchange(file_, -1));
}

void syncFolder(const std::string& folder) {
  const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

void writeFileAtomically(const std::string& path, std::string_view content) {
  PendingFile(path, content).takePlace();
  syncFolder(std::filesystem::path(path).parent_path().string());
}

}  // namespace edgeslam
