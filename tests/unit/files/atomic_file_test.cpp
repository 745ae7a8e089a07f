#include "files/atomic_file.h"

#include <sys/resource.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <functional>

#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

std::size_t entries(const std::string& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

// Files of this process cannot grow beyond some bytes: what a full disk does to a write.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST(AtomicFile, WritesAndReplaces) {
  const TemporaryFolder folder;
  const std::string big(3'000'000, 'x'), with_zeros("a\0b\n", 4);
  for (const std::string& content : {std::string("first"), big, with_zeros, std::string()}) {
    writeFileAtomically(folder.path("f"), content);
    EXPECT_EQ(fileContent(folder.path("f")), content);
    EXPECT_EQ(entries(folder.path()), 1U);
  }
  const auto permissions = std::filesystem::status(folder.path("f")).permissions();
  EXPECT_EQ(permissions & std::filesystem::perms::others_read, std::filesystem::perms::others_read);
}

TEST(AtomicFile, AFullDiskLeavesWhatWasThere) {
  const TemporaryFolder folder;
  writeFileAtomically(folder.path("f"), "before");
  {
    const FileSizeLimit limit(1000);
    expectInputError([&] { writeFileAtomically(folder.path("f"), std::string(5000, 'x')); }, folder.path("f"),
                     "cannot be written", std::strerror(EFBIG));
  }
  EXPECT_EQ(fileContent(folder.path("f")), "before");
  EXPECT_EQ(entries(folder.path()), 1U);
}

TEST(AtomicFile, AFolderThatIsNoneIsTold) {
  const TemporaryFolder folder;
  folder.write("file", "");
  expectInputError([&] { writeFileAtomically(folder.path("none/f"), "x"); }, "none/f", std::strerror(ENOENT));
  expectInputError([&] { writeFileAtomically(folder.path("file/f"), "x"); }, "file/f", std::strerror(ENOTDIR));
  std::filesystem::create_directories(folder.path("taken/inside"));
  expectInputError([&] { writeFileAtomically(folder.path("taken"), "x"); }, "taken", "cannot be written");
  EXPECT_EQ(entries(folder.path()), 2U);
}

TEST(AtomicFile, WhatAPowerCutLeftGoesWithTheNextWriting) {
  const TemporaryFolder folder;
  const std::string kept = folder.write("kept", "of another");
  const std::string left = folder.path(".f.partial");
  for (const auto& leave : std::vector<std::function<void()>>{
           [&] { folder.write(".f.partial", "half of i"); },
           [&] { std::filesystem::create_symlink(kept, left); },
           [&] { std::filesystem::create_hard_link(kept, left); },
           [&] {
             folder.write(".f.partial", "not to be read");
             std::filesystem::permissions(left, std::filesystem::perms::none);
           },
       }) {
    leave();
    writeFileAtomically(folder.path("f"), "whole");
    EXPECT_EQ(fileContent(folder.path("f")), "whole");
    EXPECT_EQ(fileContent(kept), "of another");
    EXPECT_EQ(entries(folder.path()), 2U);
  }
}

TEST(AtomicFile, OnlyOneWritesItAtATime) {
  const TemporaryFolder folder;
  {
    PendingFile first(folder.path("f"), "first");
    expectInputError([&] { writeFileAtomically(folder.path("f"), "second"); }, folder.path("f"), "another program");
    writeFileAtomically(folder.path("g"), "beside");
    first.takePlace();
  }
  EXPECT_EQ(fileContent(folder.path("f")), "first");
  { const PendingFile given_up(folder.path("f"), "never"); }
  EXPECT_EQ(fileContent(folder.path("f")), "first");
  EXPECT_EQ(entries(folder.path()), 2U);
}

}  // namespace
}  // namespace edgeslam
