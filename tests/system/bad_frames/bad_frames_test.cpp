// Frames that are not what the lens should have seen: the program does not fail, poses said to be good lie within the
// uncertainty stated with them, and soon after the fault there are good ones again. The sequences are made by ctest
// (see tests/system/CMakeLists.txt); by hand: `ctest -R BadFrames`.
#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "system/bad_frames/measured_poses.h"
#include "system/bad_frames/spoilt_sequence.h"
#include "system/run_result.h"
#include "system/surfaces.h"

namespace edgeslam {
namespace {

constexpr int length = 240;  // [frames], 30 a second
constexpr int fault = 150;   // the first bad frame, unless a test says otherwise
constexpr int a_second = 30;

std::string folderOf(const std::string& name) { return std::string(EDGESLAM_RUN_FOLDER) + "/" + name; }

struct Spoilt {
  ReplayedRun run;
  std::vector<MeasuredPose> good;
  Honesty honesty;
};

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

class BadFrames : public ::testing::TestWithParam<std::string> {
 protected:
  SpoiltSequence sequence_{folderOf(GetParam()), length};

  // What holds of every run.
  Spoilt run() {
    const std::string input = sequence_.write(folder_, "sequence");
    Spoilt result{replayed(input, folder_.path("result")), {}, {}};
    EXPECT_EQ(result.run.outcome.exit_code, 0) << result.run.outcome.messages;
    EXPECT_EQ(static_cast<int>(result.run.states.size()), sequence_.size());
    result.good = readMeasuredPoses(folder_.path("result"));
    const Honesty& honesty = result.honesty = honestyOf(result.good, readTrajectory(input + "/groundtruth.txt"));
    EXPECT_GE(honesty.share_within, 0.99) << "beyond their bound: " << ::testing::PrintToString(honesty.outside)
                                          << ", largest error " << honesty.largest_error << " m";
    RecordProperty("good", honesty.poses);
    RecordProperty("share_within_percent", std::to_string(100 * honesty.share_within));
    RecordProperty("normalised_error", std::to_string(honesty.normalised_error));
    RecordProperty("median_sigma", std::to_string(honesty.median_sigma));
    RecordProperty("largest_error_mm", std::to_string(1000 * honesty.largest_error));
    return result;
  }

  // Good again within so many frames from `first` on, and nearly always from then on.
  void expectGoodWithin(const Spoilt& result, int first, int frames) {
    const int found = result.run.firstGood(first), last = static_cast<int>(result.run.states.size()) - 1;
    ASSERT_GE(found, 0) << "never found again";
    RecordProperty("frames_to_recover", found - first);
    EXPECT_LE(found - first, frames);
    EXPECT_LE(result.run.count("lost", found, last) + result.run.count("predicted", found, last), 3);
  }

  static void expectNoneGood(const Spoilt& result, int first, int last) {
    for (const MeasuredPose& pose : result.good) {
      EXPECT_FALSE(pose.frame >= first && pose.frame <= last) << "frame " << pose.frame << " is said to be good";
    }
  }

 private:
  const TemporaryFolder folder_;
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

INSTANTIATE_TEST_SUITE_P(Places, BadFrames, ::testing::Values("hall", "parlour"),
                         [](const auto& place) { return place.param; });

}  // namespace
}  // namespace edgeslam
