// A file without a name, for what would take too much memory until a run ends. The system takes it away with the
// program, however that ends.
#pragma once

#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>

namespace edgeslam {

class ScratchFile {
 public:
  // In the folder for temporary files: TMPDIR, or /tmp.
  explicit ScratchFile(std::size_t most);

  // False where it could not be made, would become larger than `most` bytes, or the disk did not take it: problem()
  // says why, and nothing is taken any more. What was appended before can still be read.
  bool append(const void* data, std::size_t bytes);
  // False where that was never appended, or the disk does not give it back.
  bool read(std::size_t offset, void* data, std::size_t bytes);

  std::size_t size() const { return size_; }  // [byte]
  const std::string& problem() const { return problem_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  std::unique_ptr<std::FILE, Close> file_;
  std::size_t most_;
  std::size_t size_ = 0;
  std::string problem_;  // empty: none
};

}  // namespace edgeslam
