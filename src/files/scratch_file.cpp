#include "files/scratch_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <system_error>

namespace edgeslam {

ScratchFile::ScratchFile(std::size_t most) : most_(most) {
  const char* folder = std::getenv("TMPDIR");
  std::string name = std::string(folder ? folder : "/tmp") + "/edgeslam-XXXXXX";
  const int descriptor = mkostemp(name.data(), O_CLOEXEC);
  if (descriptor >= 0) {
    unlink(name.c_str());
    file_.reset(fdopen(descriptor, "w+b"));
  }
  if (file_) return;
  problem_ = std::system_category().message(errno);
  if (descriptor >= 0) close(descriptor);
}

bool ScratchFile::append(const void* data, std::size_t bytes) {
  if (!problem_.empty()) return false;
  if (bytes > most_ - size_) {
    problem_ = "it would take over " + std::to_string(most_ >> 20) + " MiB";
    return false;
  }
  // What waits in the buffer must have found its place, or it would be missed later.
  const bool is_taken = std::fseek(file_.get(), static_cast<long>(size_), SEEK_SET) == 0 &&
                        std::fwrite(data, 1, bytes, file_.get()) == bytes && std::fflush(file_.get()) == 0;
  if (!is_taken) {
    problem_ = std::system_category().message(errno);
    return false;
  }
  size_ += bytes;
  return true;
}

bool ScratchFile::read(std::size_t offset, void* data, std::size_t bytes) {
  if (!file_ || offset > size_ || bytes > size_ - offset) return false;
  return std::fseek(file_.get(), static_cast<long>(offset), SEEK_SET) == 0 &&
         std::fread(data, 1, bytes, file_.get()) == bytes;
}

}  // namespace edgeslam
