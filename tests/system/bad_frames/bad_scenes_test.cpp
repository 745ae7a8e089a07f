// Scenes and motion that mislead: as with bad frames, poses said to be good lie within the uncertainty stated with
// them.
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "system/bad_frames/spoilt_run.h"

namespace edgeslam {
namespace {

class BadScenes : public ::testing::TestWithParam<std::string>, protected SpoiltRun {
 protected:
  BadScenes() : SpoiltRun(GetParam()) {}
};

class RepeatedTexture : public ::testing::Test, protected SpoiltRun {
 protected:
  RepeatedTexture() : SpoiltRun("tiles") {}
};

class StandingStill : public ::testing::Test, protected SpoiltRun {
 protected:
  StandingStill() : SpoiltRun("hall_still") {}
};

// Something with a pattern of its own, of this coarseness [px], goes across at a height [px], at last over a third of
// the picture.
void sendAcross(std::uint64_t seed, double coarseness, int top, int first, SpoiltSequence& sequence) {
  cv::Mat object(160, 160, CV_8U);
  cv::RNG random(seed);
  random.fill(object, cv::RNG::UNIFORM, 0, 256);
  cv::GaussianBlur(object, object, {}, coarseness);
  cv::normalize(object, object, 20, 235, cv::NORM_MINMAX);
  sequence.replace(first, first + 39, [&](int index) {
    cv::Mat picture = sequence.original(index);
    const cv::Rect place(-160 + (index - first + 1) * 480 / 41, top, 160, 160);
    const cv::Rect seen = place & cv::Rect(0, 0, picture.cols, picture.rows);
    object(seen - place.tl()).copyTo(picture(seen));
    return picture;
  });
}

TEST_P(BadScenes, AMovingObject) {
  sendAcross(7, 3, 40, fault, sequence_);
  expectGoodWithin(run(), fault + 40, 5);
}

// It hides nearly all that was mapped in the parlour. What is said meanwhile may be wrong for some frames, but what
// moves must not take the map's place: once it has gone, all is as it was.
TEST_P(BadScenes, AMovingObjectThatHidesMore) {
  sendAcross(3, 2, 20, fault, sequence_);
  const Spoilt result = run(/*least_share_within=*/0.95);
  if (!result.honesty.outside.empty()) {
    EXPECT_LT(result.honesty.outside.back(), fault + 45);
  }
  EXPECT_LE(result.run.count("lost", fault + 40, length - 1), 20);
}

// Of four pictures at four times the rate, each gives a quarter of the rows: they are read one after the other, within
// the time from frame to frame. The truth is of the time when the middle is read.
TEST_P(BadScenes, RollingShutter) {
  SpoiltSequence fast(folderOf(GetParam() + "_fast"), 4 * length);
  for (int frame = 0; frame < length; ++frame) {
    const int middle = 4 * frame + 2;
    if (middle + 1 < 4 * length) {
      fast.replace(middle, middle, [&](int index) {
        cv::Mat read = fast.original(index);
        for (int quarter = 0; quarter < 4; ++quarter) {
          const cv::Range rows(read.rows * quarter / 4, read.rows * (quarter + 1) / 4);
          fast.original(index - 2 + quarter).rowRange(rows).copyTo(read.rowRange(rows));
        }
        return read;
      });
    }
    for (const int other : {0, 1, 3}) fast.drop(4 * frame + other);
  }
  sequence_ = fast;
  const Spoilt result = run();
  EXPECT_GE(result.honesty.poses, length * 2 / 3);
}

// The camera stands still and turns 40 degrees to the side and back: what comes into view has no parallax.
TEST_P(BadScenes, TurningOnTheSpot) {
  sequence_ = SpoiltSequence(folderOf(GetParam() + "_turn"), length);
  const Spoilt result = run();
  expectGoodWithin(result, fault + 60, 5);
  EXPECT_LE(result.run.count("lost", fault, fault + 59), 20);
}

// Tiles all alike along a corridor.
TEST_F(RepeatedTexture, PosesAreHonest) {
  const Spoilt result = run();
  EXPECT_GE(result.honesty.poses, length * 3 / 4);
}

// Ten minutes, at 5 frames a second: the last 30 pictures, each with noise of its own, over and over.
TEST_F(StandingStill, ForTenMinutesNothingHappens) {
  sequence_.standStill(length - 30, 3000, 0.2);
  const Spoilt result = run();
  EXPECT_EQ(result.run.count("tracking", length, sequence_.size() - 1), sequence_.size() - length);
}

// A camera that stands and has no map yet sees another room go by on a screen. It moves afterwards.
TEST_P(BadScenes, WhatMovesBeforeAStandingCameraIsNoMap) {
  constexpr int stands_until = 119;
  const cv::Mat background = sequence_.original(stands_until);
  const cv::Rect screen(70, 50, 180, 140);
  const SpoiltSequence film(folderOf(GetParam() == "hall" ? "parlour" : "hall"), length);
  sequence_.replace(0, stands_until, [&](int index) {
    cv::Mat picture = background.clone();
    film.original(index)(screen).copyTo(picture(screen));
    return picture;
  });
  const Spoilt result = run();
  EXPECT_EQ(result.run.count("tracking", 0, stands_until), 0);
  EXPECT_GE(result.run.count("tracking", length - 30, length - 1), 25);
}

INSTANTIATE_TEST_SUITE_P(Places, BadScenes, ::testing::Values("hall", "parlour"),
                         [](const auto& place) { return place.param; });

}  // namespace
}  // namespace edgeslam
