// What the fuzz targets share: files of fuzzed content that no disk sees, and how a broken promise is told.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

// Of each target: takes any bytes, ends by abort() or by a sanitizer where the program breaks a promise.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace edgeslam {

// Prints the promise and aborts where it does not hold.
void require(bool holds, const std::string& promise);

// A message for people: one line, without control characters, that names the file.
void requireMessage(const std::string& message, const std::string& name);

// A folder of this process alone, in memory; it goes when the process ends in good order.
class MemoryFolder {
 public:
  MemoryFolder();
  ~MemoryFolder();
  MemoryFolder(const MemoryFolder&) = delete;
  MemoryFolder& operator=(const MemoryFolder&) = delete;

  const std::string& path() const { return path_; }
  // Replaces what was there; `name` may lie in a folder, which is made. Returns the file's path.
  std::string write(const std::string& name, std::string_view content) const;

 private:
  std::string path_;
};

// The files of one input, parted by lines "====". At least `count` parts, the last ones empty.
std::vector<std::string_view> splitFiles(const std::uint8_t* data, std::size_t size, std::size_t count);

}  // namespace edgeslam
