// A saved map comes back to the last bit, and a damaged one is refused.
#include "map/map_file.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "edgeslam/input_error.h"
#include "map/map_check.h"
#include "unit/map/made_map.h"
#include "unit/map/same_map.h"

namespace edgeslam {
namespace {

using namespace std::string_literals;

constexpr std::size_t payload_begin = 28, checksum_size = 4;

std::string littleEndian(std::uint64_t value, std::size_t width) {
  std::string bytes;
  for (std::size_t i = 0; i < width; ++i) bytes.push_back(static_cast<char>(value >> (8 * i)));
  return bytes;
}

std::string littleEndian(const std::vector<double>& values) {
  std::string bytes;
  for (const double value : values) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    bytes += littleEndian(bits, 8);
  }
  return bytes;
}

std::uint64_t numberAt(const std::string& bytes, std::size_t place, std::size_t width = 8) {
  std::uint64_t value = 0;
  for (std::size_t i = width; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[place + i]);
  return value;
}

void overwrite(std::string& bytes, std::size_t place, const std::string& with) {
  bytes.replace(place, with.size(), with);
}

// With the payload's length and the checksum of what is there now.
std::string sealed(std::string bytes) {
  bytes.resize(bytes.size() - checksum_size);
  overwrite(bytes, 20, littleEndian(bytes.size() - payload_begin, 8));
  const auto checksum = crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size()));
  return bytes + littleEndian(checksum, 4);
}

SavedMap mapOfOneKeyframe() {
  SavedMap saved;
  saved.camera = test::madeMap(32, 24).camera;
  Keyframe keyframe;
  keyframe.world = 5;
  keyframe.frame_index = 17;
  keyframe.world_T_camera.translation = {1, 2, 3};
  keyframe.twist << 0.1, 0.2, 0.3, 0.4, 0.5, 0.6;
  keyframe.reason = "turn";
  saved.map.keyframes.push_back(keyframe);
  return saved;
}

// What decodeMap refuses the bytes with; empty where it does not.
std::string refusal(const std::string& bytes) {
  try {
    decodeMap(bytes, "hall.map");
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).rfind("hall.map: ", 0), 0U) << error.what();
    return error.what();
  }
  return "";
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(MapFile, GivesTheMapBackToTheLastBit) {
  const SavedMap saved = test::madeMap(160, 120);
  ASSERT_EQ(mapProblem(saved.camera, saved.map), "");
  ASSERT_GT(saved.map.keyframes[0].images->pyramid.levels.size(), saved.map.keyframes[4].images->pyramid.levels.size());
  const std::string bytes = encodeMap(saved);
  const SavedMap decoded = decodeMap(bytes, "hall.map");
  test::expectSame(saved, decoded);
  EXPECT_EQ(encodeMap(decoded), bytes);
}

TEST(MapFile, TheSameMapGivesTheSameBytes) {
  EXPECT_EQ(encodeMap(test::madeMap(64, 48)), encodeMap(test::madeMap(64, 48)));
}

TEST(MapFile, GivesBackRecordsOfTheLeastLength) {
  SavedMap saved = test::madeMap(32, 24);
  for (Keyframe& keyframe : saved.map.keyframes) {
    keyframe.images = nullptr;
    keyframe.reason.clear();
  }
  for (auto& [id, point] : saved.map.points) point.seen_in.clear();
  test::expectSame(saved, decodeMap(encodeMap(saved), "hall.map"));
  saved.map.points.clear();
  for (Keyframe& keyframe : saved.map.keyframes) keyframe.observations.clear();
  test::expectSame(saved, decodeMap(encodeMap(saved), "hall.map"));
}

// The layout as the header tells it, written out.
TEST(MapFile, AnEmptyMapIsAHeaderACameraAndEmptyLists) {
  SavedMap saved;
  saved.camera = {CameraModel::kannala_brandt, 640, 480, 1.5, 2, 1, 0, {0, 0, 0, 0, -2}, 0.125};
  const std::string zero = littleEndian(0, 8), one = "\0\0\0\0\0\0\xF0\x3F"s, two = "\0\0\0\0\0\0\0\x40"s;
  const std::string content = littleEndian(1, 4) + littleEndian(640, 4) + littleEndian(480, 4) +
                              "\0\0\0\0\0\0\xF8\x3F"s + two + one + zero + zero + zero + zero + zero +
                              "\0\0\0\0\0\0\0\xC0"s + "\0\0\0\0\0\0\xC0\x3F"s;
  const std::string payload = "CAMR" + littleEndian(92, 8) + content + "KEYF" + littleEndian(8, 8) + zero + "PNTS" +
                              littleEndian(8, 8) + zero + "LINE" + littleEndian(16, 8) + zero + zero + "SCAL" +
                              littleEndian(16, 8) + zero + zero;
  const std::string header = "EDGESLAM MAP\r\n\x1a\n" + littleEndian(4, 4) + littleEndian(payload.size(), 8);
  const std::string bytes = encodeMap(saved);
  EXPECT_EQ(bytes.substr(0, bytes.size() - checksum_size), header + payload);
  EXPECT_EQ(bytes, sealed(bytes));
  test::expectSame(saved, decodeMap(bytes, "hall.map"));
}

TEST(MapFile, RecordsStandAsTheHeaderTells) {
  PointObservation observation;
  observation.point = 5;
  observation.measurement = {{1, 2}, {3, 4}, 5, 6};
  observation.bearing = {7, 8, 9};
  observation.corner = true;
  observation.chain = -1;
  observation.order = 10;
  observation.straight_edge = 38;
  Keyframe keyframe;
  keyframe.id = 11;
  keyframe.world = 3;
  keyframe.frame_index = 12;
  keyframe.time_ns = -13;
  keyframe.world_T_camera = {Eigen::Quaterniond(14, 15, 16, 17), {18, 19, 20}};
  keyframe.twist << 32, 33, 34, 35, 36, 37;
  keyframe.reason = "turn";
  keyframe.observations = std::vector<PointObservation>{observation};
  keyframe.straight_edges = {{39, {{40, 41}, {42, 43, 44}}, {{45, 46}, {47, 48, 49}}, 50}};
  MapPoint point{5, 21, {22, 23, 24}, 25, 26, false, 27, 28, 29, {30, 31}};
  SavedMap saved;
  saved.map.keyframes.push_back(keyframe);
  saved.map.points.emplace(5, point);
  saved.map.lines.emplace(39, MapLine{39, 51, {{52, 53, 54}, {55, 56, 57}}, true, 58, 59, {60}});
  saved.map.next_line = 61;
  InertialAlignment& alignment = saved.map.inertia[3];
  alignment.is_known = true;
  alignment.metres_a_unit = 62;
  alignment.scale_sigma = 63;
  alignment.gravity = {64, 65, 66};
  saved.map.wheels[3] = {true, 67, 68};
  saved.map.wheels[4] = {true, 69, 70};   // a world that is gone
  saved.map.inertia[2].is_known = false;  // not known
  const std::string bytes = encodeMap(saved);

  const std::string observed = littleEndian(5, 8) + littleEndian({1, 2, 3, 4, 5, 6, 7, 8, 9}) + '\1' +
                               littleEndian(0xFFFFFFFF, 4) + littleEndian(10, 4) + littleEndian(38, 4);
  const std::string edge =
      littleEndian(39, 8) + littleEndian({40, 41, 42, 43, 44, 45, 46, 47, 48, 49}) + littleEndian({50});
  const std::string keyframes = littleEndian(1, 8) + littleEndian(11, 4) + littleEndian(3, 4) + littleEndian(12, 8) +
                                littleEndian(~12ULL, 8) + littleEndian({14, 15, 16, 17, 18, 19, 20}) +
                                littleEndian({32, 33, 34, 35, 36, 37}) + littleEndian(4, 8) + "turn" +
                                littleEndian(1, 8) + observed + littleEndian(1, 8) + edge + '\0';
  const std::string points = littleEndian(1, 8) + littleEndian(5, 8) + littleEndian(21, 4) +
                             littleEndian({22, 23, 24, 25, 26}) + '\0' + littleEndian(27, 4) + littleEndian(28, 4) +
                             littleEndian(29, 4) + littleEndian(2, 8) + littleEndian(30, 4) + littleEndian(31, 4);
  const std::string lines = littleEndian(61, 8) + littleEndian(1, 8) + littleEndian(39, 8) + littleEndian(51, 4) +
                            littleEndian({52, 53, 54, 55, 56, 57}) + '\1' + littleEndian({58, 59}) +
                            littleEndian(1, 8) + littleEndian(60, 4);
  const std::string scales = littleEndian(1, 8) + littleEndian(3, 4) + littleEndian({62, 63, 64, 65, 66}) +
                             littleEndian(1, 8) + littleEndian(3, 4) + littleEndian({67, 68});
  const std::string sections = "KEYF" + littleEndian(keyframes.size(), 8) + keyframes + "PNTS" +
                               littleEndian(points.size(), 8) + points + "LINE" + littleEndian(lines.size(), 8) +
                               lines + "SCAL" + littleEndian(scales.size(), 8) + scales;
  EXPECT_EQ(bytes.substr(payload_begin + 104, bytes.size() - payload_begin - 104 - checksum_size), sections);
}

// What its own run felt is not in the file: a unit that is switched on has other biases, and the scale is kept.
TEST(MapFile, BiasesAreThoseOfTheRunToCome) {
  SavedMap saved = test::madeMap(32, 24);
  InertialAlignment& alignment = saved.map.inertia[0];
  alignment.bias = {{0.1, 0.2, 0.3}, {0.4, 0.5, 0.6}};
  alignment.rate_bias_sigma = alignment.force_bias_sigma = 1e-4;
  alignment.is_bias_known = true;
  const InertialAlignment read = decodeMap(encodeMap(saved), "hall.map").map.inertia.at(0);
  EXPECT_TRUE(read.is_known);
  EXPECT_FALSE(read.is_bias_known);
  EXPECT_TRUE(read.bias.rate.isZero() && read.bias.force.isZero());
  EXPECT_EQ(read.rate_bias_sigma, unknown_rate_bias);
  EXPECT_EQ(read.force_bias_sigma, unknown_force_bias);
}

TEST(MapFile, AWorldWhoseScaleIsToldHasKeyframes) {
  const std::string scales = "SCAL" + littleEndian(16 + 44, 8) + littleEndian(1, 8);
  std::string bytes = encodeMap(mapOfOneKeyframe());
  bytes.erase(bytes.size() - checksum_size - 28, 28);
  bytes.insert(bytes.size() - checksum_size,
               scales + littleEndian(4, 4) + littleEndian({1, 0.1, 0, 0, standard_gravity}) + littleEndian(0, 8));
  EXPECT_EQ(refusal(sealed(bytes)), "hall.map: it tells the scale of a world that has no keyframes");
}

TEST(MapFile, EveryChangedBitIsTold) {
  std::string bytes = encodeMap(test::madeMap(32, 24));
  for (std::size_t place = 0; place < bytes.size(); ++place) {
    for (int bit = 0; bit < 8; ++bit) {
      bytes[place] = static_cast<char>(bytes[place] ^ (1 << bit));
      ASSERT_NE(refusal(bytes), "") << "byte " << place << ", bit " << bit;
      bytes[place] = static_cast<char>(bytes[place] ^ (1 << bit));
    }
  }
  EXPECT_EQ(refusal(bytes), "");
}

TEST(MapFile, EveryCutAndWhatFollowsTheEndIsTold) {
  const std::string bytes = encodeMap(test::madeMap(32, 24));
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    ASSERT_TRUE(holds(refusal(bytes.substr(0, length)), "is cut off")) << length;
  }
  EXPECT_TRUE(holds(refusal(bytes + '\0'), "is damaged"));
  EXPECT_TRUE(holds(refusal(bytes + bytes), "is damaged"));
}

TEST(MapFile, TellsWhatItIsNot) {
  EXPECT_EQ(refusal("ply\nformat binary_little_endian 1.0\n"), "hall.map: is not a map saved by edgeslam");
  std::string bytes = encodeMap(test::madeMap(32, 24));
  bytes[100] = static_cast<char>(bytes[100] + 1);
  EXPECT_EQ(refusal(bytes), "hall.map: is damaged: the checksum does not fit the content");
}

TEST(MapFile, ANewerVersionIsTold) {
  std::string bytes = encodeMap(test::madeMap(32, 24));
  overwrite(bytes, 16, littleEndian(7, 4));
  EXPECT_EQ(refusal(sealed(bytes)),
            "hall.map: map format version 7 is newer than 4, which this program reads: use a newer edgeslam");
  overwrite(bytes, 16, littleEndian(0, 4));
  EXPECT_EQ(refusal(sealed(bytes)), "hall.map: there is no map format version 0");
}

TEST(MapFile, KeepsTheWorlds) {
  SavedMap saved;
  saved.camera = test::madeMap(32, 24).camera;
  for (const KeyframeId id : {0, 1, 2}) {
    Keyframe keyframe;
    keyframe.id = id;
    keyframe.world = id / 2;
    saved.map.keyframes.push_back(keyframe);
  }
  const SavedMap read = decodeMap(encodeMap(saved), "hall.map");
  for (const KeyframeId id : {0, 1, 2}) EXPECT_EQ(read.map.keyframes[id].world, id / 2) << id;
  saved.map.keyframes[2].world = -1;
  EXPECT_EQ(refusal(encodeMap(saved)), "hall.map: keyframe 2: there is no such world");
}

// Bytes of a section taken out, by their place in its content.
void cut(std::string& bytes, const std::string& section, std::size_t place, std::size_t size) {
  const std::size_t length = bytes.find(section) + 4;
  overwrite(bytes, length, littleEndian(numberAt(bytes, length) - size, 8));
  bytes.erase(length + 8 + place, size);
}

// Which told no scales.
std::string inTheThirdVersion(std::string bytes) {
  constexpr std::size_t no_scales = 4 + 8 + 16;
  bytes.erase(bytes.size() - checksum_size - no_scales, no_scales);
  overwrite(bytes, 16, littleEndian(3, 4));
  return sealed(bytes);
}

// Which had no lines, no readout, and no motion of a keyframe; of a map without observations.
std::string inTheSecondVersion(std::string bytes) {
  bytes = inTheThirdVersion(std::move(bytes));
  constexpr std::size_t no_lines = 4 + 8 + 16;
  bytes.erase(bytes.size() - checksum_size - no_lines, no_lines);
  cut(bytes, "KEYF", numberAt(bytes, bytes.find("KEYF") + 4) - 9, 8);  // before the flag
  cut(bytes, "CAMR", 84, 8);
  cut(bytes, "KEYF", 8 + 80, 48);
  overwrite(bytes, 16, littleEndian(2, 4));
  return sealed(bytes);
}

// Which had no worlds either.
std::string inTheFirstVersion(std::string bytes) {
  bytes = inTheSecondVersion(bytes);
  cut(bytes, "KEYF", 8 + 4, 4);
  overwrite(bytes, 16, littleEndian(1, 4));
  return sealed(bytes);
}

TEST(MapFile, ReadsTheVersionsBefore) {
  SavedMap saved = mapOfOneKeyframe();
  const std::string bytes = encodeMap(saved);
  test::expectSame(saved, decodeMap(bytes, "hall.map"));
  test::expectSame(saved, decodeMap(inTheThirdVersion(bytes), "hall.map"));
  saved.camera.readout_s = 0;
  saved.map.keyframes[0].twist.setZero();
  const SavedMap second = decodeMap(inTheSecondVersion(bytes), "hall.map");
  test::expectSame(saved, second);
  EXPECT_EQ(second.map.keyframes[0].world, 5);
  const SavedMap first = decodeMap(inTheFirstVersion(bytes), "hall.map");
  test::expectSame(saved, first);
  EXPECT_EQ(first.map.keyframes[0].world, 0);
}

// It has the fewest bytes that a keyframe ever had, which the count of keyframes is held against.
TEST(MapFile, ReadsTheShortestKeyframeOfTheFirstVersion) {
  SavedMap saved = mapOfOneKeyframe();
  saved.map.keyframes[0].reason.clear();
  EXPECT_EQ(decodeMap(inTheFirstVersion(encodeMap(saved)), "hall.map").map.keyframes.size(), 1U);
}

TEST(MapFile, KeepsTheReadoutAndTheMotionOfKeyframes) {
  SavedMap saved = mapOfOneKeyframe();
  saved.camera.readout_s = -0.2;
  const SavedMap read = decodeMap(encodeMap(saved), "hall.map");
  EXPECT_EQ(read.camera.readout_s, -0.2);
  EXPECT_EQ(read.map.keyframes[0].twist, saved.map.keyframes[0].twist);
}

// Bytes put anywhere under a checksum that fits them: refused, or a map that keeps to every rule.
TEST(MapFile, WhateverStandsUnderAFittingChecksumIsRefusedOrAMap) {
  const std::string bytes = encodeMap(test::madeMap(32, 24));
  std::vector<std::string> patterns{"\x01", "\x7F", "\x80", "\xFF"};
  for (const std::uint64_t number : {0x0ULL, 0x7FF8000000000000ULL, 0x7FF0000000000000ULL, 0x7FEFFFFFFFFFFFFFULL,
                                     0x7FFFFFFFFFFFFFFFULL, 0x8000000000000000ULL, 0xFFFFFFFFFFFFFFFFULL}) {
    patterns.push_back(littleEndian(number, 8));
  }
  int refused = 0, accepted = 0;
  for (const std::string& pattern : patterns) {
    for (std::size_t place = payload_begin; place + pattern.size() + checksum_size <= bytes.size(); ++place) {
      std::string crafted = bytes;
      overwrite(crafted, place, pattern);
      try {
        const SavedMap decoded = decodeMap(sealed(crafted), "hall.map");
        ASSERT_EQ(cameraProblem(decoded.camera), "");
        ASSERT_EQ(mapProblem(decoded.camera, decoded.map), "");
        ++accepted;
      } catch (const InputError&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 1000);
  EXPECT_GT(accepted, 1000);
}

// Every length and count in turn said to be larger or smaller than it is.
TEST(MapFile, LengthsAndCountsAreHeldAgainstTheBytes) {
  const std::string bytes = encodeMap(test::madeMap(32, 24));
  const std::size_t camera = payload_begin + 4, keyframes = bytes.find("KEYF") + 4, points = bytes.rfind("PNTS") + 4;
  const std::size_t reason = keyframes + 16 + 128, image = bytes.find("\x89PNG") - 8;
  for (const std::size_t place :
       {camera, keyframes, keyframes + 8, reason, reason + 8, image, points, points + 8, points + 16 + 65}) {
    const std::uint64_t right = numberAt(bytes, place);
    for (const std::uint64_t wrong :
         {right - 1, right + 1, right + 8, right + (std::uint64_t{1} << 32), right + (std::uint64_t{1} << 62)}) {
      std::string crafted = bytes;
      overwrite(crafted, place, littleEndian(wrong, 8));
      EXPECT_NE(refusal(sealed(crafted)), "") << "byte " << place << ": " << wrong << " for " << right;
    }
  }
}

TEST(MapFile, BytesThatBelongToNothingAreTold) {
  const std::string bytes = encodeMap(test::madeMap(32, 24));
  std::string after_points = bytes;
  after_points.insert(bytes.size() - checksum_size, "more");
  EXPECT_TRUE(holds(refusal(sealed(after_points)), "4 bytes too many"));
  for (const char* section : {"CAMR", "KEYF", "PNTS"}) {
    const std::size_t length = bytes.rfind(section) + 4;
    std::string crafted = bytes;
    crafted.insert(length + 8 + numberAt(bytes, length), "more");
    overwrite(crafted, length, littleEndian(numberAt(bytes, length) + 4, 8));
    EXPECT_TRUE(holds(refusal(sealed(crafted)), "4 bytes too many")) << section;
    crafted = bytes;
    overwrite(crafted, length - 4, "XYZW");
    EXPECT_TRUE(holds(refusal(sealed(crafted)), "expected section "s + section)) << section;
  }
}

TEST(MapFile, FlagsAreZeroOrOne) {
  std::string bytes = encodeMap(test::madeMap(32, 24));
  const std::size_t has_images = bytes.find("\x89PNG") - 8 - 4 - 16 - 1;
  ASSERT_EQ(bytes[has_images], 1);
  bytes[has_images] = 2;
  EXPECT_TRUE(holds(refusal(sealed(bytes)), "expected 0 or 1, found 2"));
}

// The map's bytes with another first image.
std::string withImage(std::string bytes, const std::string& image) {
  const std::size_t keyframes = bytes.find("KEYF") + 4, place = bytes.find("\x89PNG") - 8;
  const std::uint64_t length = numberAt(bytes, place);
  bytes.replace(place, 8 + length, littleEndian(image.size(), 8) + image);
  overwrite(bytes, keyframes, littleEndian(numberAt(bytes, keyframes) + image.size() - length, 8));
  return sealed(bytes);
}

std::string encoded(const std::string& format, const cv::Mat& image) {
  std::vector<unsigned char> bytes;
  EXPECT_TRUE(cv::imencode(format, image, bytes));
  return {bytes.begin(), bytes.end()};
}

TEST(MapFile, OnlyGreyPngOfTheCamerasSizeIsDecoded) {
  const std::string bytes = encodeMap(test::madeMap(32, 24));
  const cv::Mat grey = test::noiseImage(32, 24, 5);
  const std::string good = encoded(".png", grey);
  ASSERT_EQ(refusal(withImage(bytes, good)), "");
  cv::Mat colour, deep;
  cv::merge(std::vector<cv::Mat>{grey, grey, grey}, colour);
  grey.convertTo(deep, CV_16U);
  std::string huge = good;
  overwrite(huge, 16, "\0\0\x80\0\0\0\x80\0"s);
  for (const std::string& image :
       {std::string(), encoded(".png", test::noiseImage(24, 32, 5)), encoded(".png", test::noiseImage(320, 240, 5)),
        encoded(".png", colour), encoded(".png", deep), encoded(".bmp", grey), huge}) {
    EXPECT_TRUE(holds(refusal(withImage(bytes, image)), "no grey PNG of the camera's size"));
  }
}

TEST(MapFile, DamagedImagesAreTold) {
  const std::string bytes = encodeMap(test::madeMap(32, 24));
  const std::string good = encoded(".png", test::noiseImage(32, 24, 5));
  for (const std::size_t length : {std::size_t{33}, std::size_t{60}, good.size() / 2, good.size() - 20}) {
    EXPECT_NE(refusal(withImage(bytes, good.substr(0, length))), "") << length;
  }
  std::string changed = good;
  changed[good.size() / 2] = static_cast<char>(changed[good.size() / 2] + 1);
  EXPECT_TRUE(holds(refusal(withImage(bytes, changed)), "is damaged"));
}

TEST(MapFile, PyramidLevelsAreThoseOfTheImagesSize) {
  const std::string bytes = encodeMap(test::madeMap(32, 24));
  const std::size_t levels = bytes.find("\x89PNG") - 12;
  ASSERT_EQ(numberAt(bytes, levels, 4), 1U);
  for (const std::uint64_t wrong : {0x0ULL, 0x2ULL, 0x7FFFFFFFULL, 0x80000000ULL, 0xFFFFFFFFULL}) {
    std::string crafted = bytes;
    overwrite(crafted, levels, littleEndian(wrong, 4));
    EXPECT_TRUE(holds(refusal(sealed(crafted)), "pyramid levels")) << wrong;
  }
}

}  // namespace
}  // namespace edgeslam
