// Frames that are not what the lens should have seen: the program does not fail, poses said to be good lie within the
// uncertainty stated with them, and soon after the fault there are good ones again. The sequences are made by ctest
// (see tests/system/CMakeLists.txt); by hand: `ctest -R BadFrames`.
#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "system/bad_frames/spoilt_run.h"
#include "system/surfaces.h"

namespace edgeslam {
namespace {

constexpr int a_second = 30;  // [frames]

// Of the map's points, from where the camera was halfway [map units].
double medianDepth(const Spoilt& result) {
  const Pose camera_T_map = result.good.at(result.good.size() / 2).map_T_camera.inverse();
  std::vector<double> depths;
  for (const Eigen::Vector3d& point : readMapPoints(result.run.folder + "/map.ply")) {
    depths.push_back((camera_T_map * point).z());
  }
  if (depths.empty()) return 0;
  std::nth_element(depths.begin(), depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2), depths.end());
  return depths[depths.size() / 2];
}

class BadFrames : public ::testing::TestWithParam<std::string>, protected SpoiltRun {
 protected:
  BadFrames() : SpoiltRun(GetParam()) {}
};

cv::Mat flat(int grey) { return cv::Mat(240, 320, CV_8U, cv::Scalar(grey)); }

// Nothing is wrong with these frames. The stated variance is neither too small, nor so large that it says nothing. It
// is meant to be too large rather than too small: errors of neighbouring points go together, how much is not known.
TEST_P(BadFrames, NoneAndTheCovarianceIsHonest) {
  const Spoilt result = run();
  EXPECT_GE(result.honesty.poses, length * 3 / 4);
  EXPECT_GE(result.honesty.normalised_error, 0.02);
  EXPECT_LE(result.honesty.normalised_error, 2);
  EXPECT_LT(result.honesty.median_sigma, 0.05 * medianDepth(result));
  EXPECT_EQ(result.run.count("lost", 0, length - 1) + result.run.count("predicted", 0, length - 1), 0);
}

TEST_P(BadFrames, Black) {
  sequence_.replace(fault, fault + 9, [](int) { return flat(0); });
  const Spoilt result = run();
  expectNoneGood(result, fault, fault + 9);
  expectGoodWithin(result, fault + 10, a_second);
}

TEST_P(BadFrames, White) {
  sequence_.replace(fault, fault + 9, [](int) { return flat(255); });
  const Spoilt result = run();
  expectNoneGood(result, fault, fault + 9);
  expectGoodWithin(result, fault + 10, a_second);
}

TEST_P(BadFrames, Noise) {
  sequence_.replace(fault, fault + 9, [](int index) {
    cv::Mat noise = flat(0);
    cv::RNG random(static_cast<std::uint64_t>(index));
    random.fill(noise, cv::RNG::UNIFORM, 0, 256);
    return noise;
  });
  const Spoilt result = run();
  expectNoneGood(result, fault, fault + 9);
  expectGoodWithin(result, fault + 10, a_second);
}

TEST_P(BadFrames, Saturated) {
  sequence_.replace(fault, fault + 19, [&](int index) {
    cv::Mat bright = sequence_.original(index);
    bright.setTo(255, bright > 200);
    return bright;
  });
  expectGoodWithin(run(), fault + 20, 5);
}

// A hand that lets some light through and has no edges.
TEST_P(BadFrames, LensCovered) {
  sequence_.replace(fault, fault + 19, [&](int index) {
    cv::Mat covered;
    cv::GaussianBlur(sequence_.original(index) * 0.1 + 12, covered, {}, 25);
    return covered;
  });
  const Spoilt result = run();
  expectNoneGood(result, fault, fault + 19);
  expectGoodWithin(result, fault + 20, a_second);
}

// A screen that fills the picture and shows another place.
TEST_P(BadFrames, AnotherSceneOnAScreen) {
  const SpoiltSequence other(folderOf(GetParam() == "hall" ? "parlour" : "hall"), length);
  sequence_.replace(fault, fault + 19, [&](int index) { return other.original(index); });
  const Spoilt result = run();
  expectNoneGood(result, fault, fault + 19);
  expectGoodWithin(result, fault + 20, a_second);
}

// From a gain of 0.4 to one of 2 and back, every 10 frames.
TEST_P(BadFrames, ExposureJumps) {
  sequence_.replace(fault - 30, fault + 49, [&](int index) {
    cv::Mat exposed;
    sequence_.original(index).convertTo(exposed, CV_8U, index / 10 % 2 == 0 ? 0.4 : 2.0);
    return exposed;
  });
  expectGoodWithin(run(), fault + 50, 5);
}

// Every fifth picture comes twice, in the place of the next.
TEST_P(BadFrames, Repeated) {
  for (int i = fault; i < fault + 60; i += 5) sequence_.repeat(i, i - 1);
  expectGoodWithin(run(), fault + 60, 3);
}

TEST_P(BadFrames, Missing) {
  for (int i = fault; i < fault + 60; i += 5) {
    sequence_.drop(i);
    if (i % 10 == 0) sequence_.drop(i + 1);
  }
  expectGoodWithin(run(), fault + 42, 3);
}

// The upper half of each, the lower half of the one 5 before: as a driver does that hands out a buffer half filled.
TEST_P(BadFrames, Torn) {
  sequence_.replace(fault, fault + 9, [&](int index) {
    cv::Mat torn = sequence_.original(index);
    const cv::Range lower(torn.rows / 2, torn.rows);
    sequence_.original(index - 5).rowRange(lower).copyTo(torn.rowRange(lower));
    return torn;
  });
  expectGoodWithin(run(), fault + 10, 10);
}

INSTANTIATE_TEST_SUITE_P(Places, BadFrames, ::testing::Values("hall", "parlour"),
                         [](const auto& place) { return place.param; });

}  // namespace
}  // namespace edgeslam
