#include "benchmark/sequence_search.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

namespace fs = std::filesystem;

const char* const camera_text = "width: 64\nheight: 48\nfx: 50\nfy: 50\ncx: 32\ncy: 24\n";

void makeTum(const TemporaryFolder& folder, const std::string& name) {
  folder.write(name + "/rgb/1.000000.png", "no image");
  folder.write(name + "/rgb/1.100000.png", "no image");
  folder.write(name + "/rgb.txt", "1.000000 rgb/1.000000.png\n1.100000 rgb/1.100000.png\n");
}

std::vector<std::string> namesIn(const SequenceSearch& search) {
  std::vector<std::string> names;
  for (const FoundSequence& sequence : search.sequences) names.push_back(sequence.name);
  return names;
}

using Names = std::vector<std::string>;

TEST(SequenceSearch, findsEveryKindAndNothingElse) {
  const TemporaryFolder folder;
  makeTum(folder, "tum/rgbd_dataset_freiburg1_xyz");
  folder.write("icl/office0/associations.txt", "1 depth/1.png 1 rgb/1.png\n");
  folder.write("euroc/MH_01/mav0/cam0/data.csv", "#timestamp [ns],filename\n1403636579763555584,a.png\n");
  folder.write("euroc/MH_01/mav0/cam0/data/a.png", "no image");
  folder.write("ours/1.000000.png", "no image");
  folder.write("ours/camera.yaml", camera_text);
  folder.write("pictures/1.000000.png", "an illustration");
  folder.write("notes/readme.txt", "nothing");
  const SequenceSearch search = findSequences(folder.path(), folder.path("benchmark"));
  EXPECT_EQ(namesIn(search), (Names{"MH_01", "office0", "ours", "rgbd_dataset_freiburg1_xyz"}));
  const FoundSequence& tum = search.sequences.back();
  EXPECT_EQ(tum.kind, "TUM RGB-D folder");
  EXPECT_EQ(tum.frames, 2);
  EXPECT_FALSE(tum.has_calibration);
  EXPECT_TRUE(search.sequences[2].has_calibration);
  EXPECT_TRUE(search.notes.empty());
}

TEST(SequenceSearch, aBrokenSequenceIsFoundWithItsProblem) {
  const TemporaryFolder folder;
  folder.write("broken/rgb.txt", "nonsense\n");
  const SequenceSearch search = findSequences(folder.path(), "");
  ASSERT_EQ(namesIn(search), Names{"broken"});
  EXPECT_NE(search.sequences[0].problem.find("rgb.txt:1"), std::string::npos) << search.sequences[0].problem;
}

TEST(SequenceSearch, theFolderItselfCanBeTheSequence) {
  const TemporaryFolder folder;
  makeTum(folder, "desk");
  EXPECT_EQ(namesIn(findSequences(folder.path("desk"), "")), Names{"desk"});
}

TEST(SequenceSearch, linksLeadEachFolderOnceAndLoopsEnd) {
  const TemporaryFolder folder;
  makeTum(folder, "a/desk");
  fs::create_directory_symlink(folder.path("a/desk"), folder.path("a/another_name"));
  fs::create_directory_symlink(folder.path(), folder.path("a/loop"));
  fs::create_directory_symlink(folder.path("nowhere"), folder.path("a/dangling"));
  EXPECT_EQ(namesIn(findSequences(folder.path(), "")), Names{"desk"});
}

TEST(SequenceSearch, leavesOutHiddenFoldersResultsAndWhatLiesTooDeep) {
  const TemporaryFolder folder;
  makeTum(folder, ".trash/old");
  makeTum(folder, "benchmark/desk");
  makeTum(folder, "1/2/3/4/5/6/deep");
  makeTum(folder, "1/2/3/4/5/near");
  const SequenceSearch search = findSequences(folder.path(), folder.path("benchmark"));
  EXPECT_EQ(namesIn(search), Names{"near"});
  ASSERT_EQ(search.notes.size(), 1U);
  EXPECT_NE(search.notes[0].find("1/2/3/4/5/6: deeper"), std::string::npos) << search.notes[0];
}

TEST(SequenceSearch, namesAreUnique) {
  const TemporaryFolder folder;
  for (const char* name : {"monday/desk", "tuesday/desk", "tuesday/hall", "tuesday_desk"}) makeTum(folder, name);
  Names names = namesIn(findSequences(folder.path(), ""));
  EXPECT_EQ(names.size(), 4U);
  EXPECT_EQ(std::unique(names.begin(), names.end()), names.end());
  EXPECT_NE(std::find(names.begin(), names.end(), "monday_desk"), names.end());
  for (const std::string& name : names) EXPECT_EQ(name.find('/'), std::string::npos) << name;
}

TEST(SequenceSearch, whatIsNoFolderOrHasTooManyIsTold) {
  const TemporaryFolder folder;
  const std::string file = folder.write("file", "");
  expectInputError([&] { findSequences(file, ""); }, "file", "no folder");
  expectInputError([&] { findSequences(folder.path("missing"), ""); }, "missing", "no folder");
  for (int i = 0; i < 20; ++i) fs::create_directory(folder.path("d" + std::to_string(i)));
  expectInputError([&] { findSequences(folder.path(), "", {6, 10}); }, "more than 10 folders");
}

TEST(SequenceFingerprint, changesWithEveryFile) {
  const TemporaryFolder folder;
  makeTum(folder, "desk");
  const std::string before = sequenceFingerprint(folder.path("desk"));
  EXPECT_EQ(sequenceFingerprint(folder.path("desk")), before);
  folder.write("desk/camera.yaml", camera_text);
  const std::string with_camera = sequenceFingerprint(folder.path("desk"));
  EXPECT_NE(with_camera, before);
  folder.write("desk/rgb/1.100000.png", "another image");
  EXPECT_NE(sequenceFingerprint(folder.path("desk")), with_camera);
}

}  // namespace
}  // namespace edgeslam
