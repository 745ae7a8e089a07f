// Maps are saved whole or not at all, and read back for the same camera.
#include "map/saved_map.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <stdexcept>

#include "geometry/millionths.h"
#include "unit/files/resource_limit.h"
#include "unit/files/temporary_folder.h"
#include "unit/map/made_map.h"

namespace edgeslam {
namespace {

namespace fs = std::filesystem;

std::ptrdiff_t entries(const std::string& folder) { return std::distance(fs::directory_iterator(folder), {}); }

TEST(SavedMapFile, IsTheMapsBytesAndGivesTheMapBack) {
  const TemporaryFolder folder;
  const SavedMap saved = test::madeMap(64, 48);
  saveMap(folder.path("hall.map"), saved.camera, saved.map);
  EXPECT_EQ(fileContent(folder.path("hall.map")), encodeMap(saved));
  const Map loaded = loadMap(folder.path("hall.map"), saved.camera);
  EXPECT_EQ(encodeMap({saved.camera, loaded}), encodeMap(saved));
  EXPECT_EQ(entries(folder.path()), 1);
}

TEST(SavedMapFile, AFullDiskLeavesTheEarlierMap) {
  const TemporaryFolder folder;
  const std::string path = folder.write("hall.map", "an earlier one");
  const SavedMap saved = test::madeMap(64, 48);
  ASSERT_GT(encodeMap(saved).size(), 3000U);
  {
    const ResourceLimit limit(RLIMIT_FSIZE, 3000);
    expectInputError([&] { saveMap(path, saved.camera, saved.map); }, path, "cannot be written", std::strerror(EFBIG));
  }
  EXPECT_EQ(fileContent(path), "an earlier one");
  EXPECT_EQ(entries(folder.path()), 1);
}

TEST(SavedMapFile, AMapThatWouldNotBeReadBackIsNotWritten) {
  const TemporaryFolder folder;
  const std::string path = folder.write("hall.map", "an earlier one");
  SavedMap saved = test::madeMap(64, 48);
  saved.map.points.begin()->second.inverse_depth = std::nan("");
  EXPECT_THROW(saveMap(path, saved.camera, saved.map), std::logic_error);
  EXPECT_EQ(fileContent(path), "an earlier one");
}

TEST(SavedMapFile, OnlyTheCameraThatItWasMadeWithFits) {
  const TemporaryFolder folder;
  const SavedMap saved = test::madeMap(64, 48);
  saveMap(folder.path("hall.map"), saved.camera, saved.map);
  Camera other = saved.camera;
  other.distortion[4] = std::nextafter(other.distortion[4], 1.0);
  expectInputError([&] { loadMap(folder.path("hall.map"), other); }, folder.path("hall.map"), "calibration");
  other = saved.camera;
  other.model = CameraModel::pinhole_radial_tangential;
  expectInputError([&] { loadMap(folder.path("hall.map"), other); }, folder.path("hall.map"), "calibration");
}

TEST(SavedMapFile, AnotherReadoutIsTold) {
  const TemporaryFolder folder;
  SavedMap saved = test::madeMap(64, 48);
  saved.camera.readout_s = 0;
  const std::string path = folder.write("hall.map", encodeMap(saved));
  Camera other = saved.camera;
  other.readout_s = 0.02;
  expectInputError([&] { loadMap(path, other); }, path, "another calibration", "its readout is 0 s, theirs is 0.02 s");
}

// The next run with the same calibration goes on with what the one before found, to the last bit.
TEST(SavedMapFile, WhatWasFoundOfTheCameraComesBack) {
  const TemporaryFolder folder;
  SavedMap saved = test::madeMap(64, 48);
  saved.camera.readout_s = 0;
  for (const double times : {0.9263, 1.0, 1.0871}) {
    saved.map.found = {0.0213, inMillionths(times)};
    saveMap(folder.path("found.map"), saved.camera, saved.map);
    EXPECT_EQ(loadMap(folder.path("found.map"), saved.camera).found, saved.map.found) << times;
  }
  for (const std::array<double, 2> radial : {std::array<double, 2>{0.0713, -0.0321}, {-0.21, 0.13}}) {
    saved.map.found = {std::nullopt, inMillionths(1.06), {inMillionths(radial[0]), inMillionths(radial[1])}};
    saveMap(folder.path("found.map"), saved.camera, saved.map);
    EXPECT_EQ(loadMap(folder.path("found.map"), saved.camera).found, saved.map.found) << radial[0];
  }
  saved.map.found = {std::nullopt, 1, {}, {inMillionths(3.37), inMillionths(-2.11)}};
  saveMap(folder.path("found.map"), saved.camera, saved.map);
  EXPECT_EQ(loadMap(folder.path("found.map"), saved.camera).found, saved.map.found);
  Camera far_off = saved.camera;
  far_off.cx += 0.2 * far_off.width;
  expectInputError([&] { loadMap(folder.path("found.map"), far_off); }, folder.path("found.map"), "calibration");
  Camera other = saved.camera;
  other.fx *= 1.02;
  expectInputError([&] { loadMap(folder.path("found.map"), other); }, folder.path("found.map"), "calibration");
  saved.map.found.focal_scale = inMillionths(1.5);
  saveMap(folder.path("far_off.map"), saved.camera, saved.map);
  expectInputError([&] { loadMap(folder.path("far_off.map"), saved.camera); }, folder.path("far_off.map"),
                   "calibration");
}

TEST(SavedMapFile, WithoutAKeyframeThereIsNothingToGoOnFrom) {
  const TemporaryFolder folder;
  const SavedMap made = test::madeMap(64, 48);
  const std::string path = folder.write("empty.map", encodeMap({made.camera, Map()}));
  expectInputError([&] { loadMap(path, made.camera); }, path, "no keyframe");
}

TEST(SavedMapFile, WhatIsNoMapIsToldByItsName) {
  const TemporaryFolder folder;
  const SavedMap saved = test::madeMap(64, 48);
  const std::string whole = encodeMap(saved);
  const auto expectRefused = [&](const std::string& path, const char* text) {
    expectInputError([&] { loadMap(path, saved.camera); }, path, text);
  };
  expectRefused(folder.path("missing.map"), "no such file");
  expectRefused(folder.path(), "no file");
  expectRefused("/dev/zero", "no file");
  expectRefused(folder.write("no.map", ""), "cut off after 0 bytes");
  expectRefused(folder.write("notes.map", "not a map"), "not a map");
  expectRefused(folder.write("film.map", std::string(100'000, 'f')), "not a map");
  expectRefused(folder.write("short.map", whole.substr(0, 10)), "cut off");
  expectRefused(folder.write("sixteen.map", whole.substr(0, 16)), "cut off");
  expectRefused(folder.write("cut.map", whole.substr(0, whole.size() / 2)), "cut off");
  expectRefused(folder.write("long.map", whole + "x"), "damaged");
  fs::create_symlink(folder.path("nowhere"), folder.path("link.map"));
  expectRefused(folder.path("link.map"), "no such file");
}

// Files of nothing but length, which take no place on the disk. Of what doesn't begin as a map little is read, so these
// need neither the time nor the memory.
TEST(SavedMapFile, HugeFilesAreToldAtOnce) {
  const TemporaryFolder folder;
  const Camera camera = test::madeMap(64, 48).camera;
  const std::string path = folder.write("film.map", "");
  fs::resize_file(path, std::uintmax_t{8} << 30);
  expectInputError([&] { loadMap(path, camera); }, path, "not a map");
  fs::resize_file(path, (std::uintmax_t{8} << 30) + 1);
  expectInputError([&] { loadMap(path, camera); }, path, "too large");
}

TEST(SavedMapFile, WhereNoMapCanBeSavedIsToldBeforehand) {
  const TemporaryFolder folder;
  const std::string file = folder.write("file", "a file stands here");
  const auto expectRefused = [&](const std::string& path, const std::string& text) {
    expectInputError([&] { requireMapCanBeSaved(path); }, path, text);
  };
  expectRefused(folder.path(), "no file");
  expectRefused("/dev/full", "no file");
  expectRefused(folder.path("none/hall.map"), folder.path("none") + " is no folder");
  expectRefused(file + "/hall.map", file + " is no folder");
  expectRefused("/proc/hall.map", "cannot be saved");
  expectRefused(folder.path(std::string(300, 'x')), std::strerror(ENAMETOOLONG));
  if (geteuid() != 0) {
    fs::create_directory(folder.path("locked"));
    fs::permissions(folder.path("locked"), fs::perms::owner_read | fs::perms::owner_exec);
    expectRefused(folder.path("locked/hall.map"), std::strerror(EACCES));
  }
  EXPECT_EQ(fileContent(file), "a file stands here");
}

TEST(SavedMapFile, WhereItCanNothingIsLeftBehind) {
  const TemporaryFolder folder;
  const std::string file = folder.write("hall.map", "an earlier one");
  EXPECT_NO_THROW(requireMapCanBeSaved(file));
  EXPECT_NO_THROW(requireMapCanBeSaved(folder.path("new.map")));
  EXPECT_EQ(fileContent(file), "an earlier one");
  EXPECT_EQ(entries(folder.path()), 1);
}

}  // namespace
}  // namespace edgeslam
