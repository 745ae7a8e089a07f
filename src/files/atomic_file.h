// Files that are there whole or not at all.
#pragma once

#include <string>
#include <string_view>

namespace edgeslam {

// Writes `content` to a file beside `path`, syncs it, and renames it to `path`, replacing what was there. Throws
// InputError with path and the system's reason (full disk, folder that cannot be written), leaving neither that file
// nor a changed `path` behind.
void writeFileAtomically(const std::string& path, std::string_view content);

// The same in two steps, for files that are to change together. Beside "folder/name" it writes "folder/.name.partial":
// always the same name, so that what a power cut left there goes with the next writing, and does not fill the disk.
class PendingFile {
 public:
  // Writes and syncs. Throws InputError, also where another program is writing the same file.
  PendingFile(const std::string& path, std::string_view content);
  // Without takePlace(), nothing has happened.
  ~PendingFile();
  PendingFile(PendingFile&& other) noexcept;
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;
  PendingFile& operator=(PendingFile&&) = delete;

  // Once. Throws InputError. A power cut may still take it back, until syncFolder().
  void takePlace();

 private:
  std::string path_, temporary_;
  int file_ = -1;  // open and locked until it is over
};

// What the folder has of names must outlive a power cut, too. A file system that cannot sync folders is no reason to
// fail. Empty: the folder where the program runs.
void syncFolder(const std::string& folder);

}  // namespace edgeslam
