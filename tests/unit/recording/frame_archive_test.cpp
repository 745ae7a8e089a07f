#include "recording/frame_archive.h"

#include <cstdlib>

#include "unit/recording/made_recording.h"

namespace edgeslam {
namespace {

std::string member(const std::string& name, std::int64_t time_ns, const std::string& content) {
  const auto header = archiveHeader(name, time_ns, content.size());
  return std::string(header.data(), header.size()) + content + std::string(archivePadding(content.size()), '\0');
}

// Sizes about a block's.
const std::vector<std::size_t> sizes{1, 511, 512, 513, 100'000};

TEST(FrameArchive, TarUnpacksIt) {
  const TemporaryFolder folder;
  std::string archive;
  for (const std::size_t size : sizes) {
    archive += member("rgb/" + std::to_string(size) + ".pgm", 1305031102'500'000'000, std::string(size, 'x'));
    EXPECT_EQ(archive.size() % archive_block, 0U);
  }
  EXPECT_EQ(unpacked(archive).size(), sizes.size());
  const std::string file = folder.write("rgb.tar", archive);
  ASSERT_EQ(std::system(("tar -x -f " + file + " -C " + folder.path() + " 2> " + folder.path("said")).c_str()), 0);
  EXPECT_EQ(fileContent(folder.path("said")), "");
  for (const std::size_t size : sizes) {
    const std::string name = folder.path("rgb/" + std::to_string(size) + ".pgm");
    EXPECT_EQ(fileContent(name), std::string(size, 'x'));
    EXPECT_EQ(std::system(("test $(stat -c %Y " + name + ") = 1305031102").c_str()), 0);
  }
}

TEST(FrameArchive, AnImageIsReadWholeOrToldWithItsPlace) {
  const TemporaryFolder folder;
  const std::string image = "P5 the content of an image";
  const std::string archive = member("rgb/1.pgm", 0, "before") + member("rgb/2.pgm", 0, image);
  const std::string path = folder.write("rgb.tar", archive);
  const ArchivedImage where{static_cast<std::int64_t>(archive.find(image)), static_cast<std::int64_t>(image.size()),
                            imageChecksum(image)};
  EXPECT_EQ(readArchivedImage(path, where).bytes, image);
  EXPECT_EQ(readArchivedImage(path, where).problem, "");

  const auto problem = [&](const ArchivedImage& image_there) {
    const ArchivedBytes read = readArchivedImage(path, image_there);
    EXPECT_TRUE(read.bytes.empty());
    return read.problem;
  };
  ArchivedImage other = where;
  other.checksum ^= 1U;
  EXPECT_EQ(problem(other), path + ": at byte 1536: the frame is damaged: its checksum is another one");
  for (std::size_t size = 0; size < archive.size(); ++size) {
    folder.write("rgb.tar", archive.substr(0, size));
    const bool is_there = size >= 1536 + image.size();
    EXPECT_EQ(readArchivedImage(path, where).problem, is_there ? "" : path + ": at byte 1536: the frame is cut off");
  }
  folder.write("rgb.tar", archive);
  for (std::size_t i = 0; i < image.size(); ++i) {
    std::string damaged = archive;
    damaged[1536 + i] ^= 4;
    folder.write("rgb.tar", damaged);
    EXPECT_NE(problem(where).find("damaged"), std::string::npos);
  }
  std::filesystem::remove(path);
  EXPECT_EQ(problem(where), path + ": no such file");
}

// No memory is taken for it, which would throw.
TEST(FrameArchive, WhatNoFileCanHoldIsCutOff) {
  const TemporaryFolder folder;
  const std::string path = folder.write("rgb.tar", std::string(2000, 'x'));
  constexpr std::int64_t most = 4'000'000'000'000'000'000;
  for (const ArchivedImage& image : {ArchivedImage{512, most, 0}, ArchivedImage{most, most, 0},
                                     ArchivedImage{most, 1, 0}, ArchivedImage{1999, 2, 0}}) {
    EXPECT_NE(readArchivedImage(path, image).problem.find("cut off"), std::string::npos);
  }
}

TEST(FrameArchive, TheChecksumIsTheCustomaryOne) { EXPECT_EQ(imageChecksum("end"), 0x00fc33b1U); }

}  // namespace
}  // namespace edgeslam
