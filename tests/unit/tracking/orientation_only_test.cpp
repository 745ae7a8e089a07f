// Orientation where the map does not tell the pose: from tracks without depth, with the position held.
#include "tracking/orientation_only.h"

#include <gtest/gtest.h>

#include "unit/adjustment/synthetic_scene.h"
#include "unit/tracking/textured_plane.h"

namespace edgeslam {
namespace {

constexpr double turning_frame_s = 1 / 30.0;

// A camera in keyframe 0 that turns, and may move, by `world_T_now`; what it tracks lies 2 to 4 units away. Of these
// tracks the first `mapped` are of map points.
class OrientationOnly : public ::testing::Test {
 protected:
  OrientationOnly() {
    view_.initialised = true;
    view_.keyframes = {{0, Pose(), imagesOf(cv::Mat(240, 320, CV_8U, cv::Scalar(90)))}};
    held_.covariance = 1e-8 * Matrix6d::Identity();
    held_.seconds_ago = turning_frame_s;
    held_.scene_depth = 3;
  }

  void follow(const Pose& world_T_now, int mapped, int count = 200) {
    test::Random random(5);
    for (PointId id = 0; static_cast<int>(tracks_.size()) < count; ++id) {
      const Eigen::Vector2d before = test::randomPixel(random, camera_);
      const Eigen::Vector3d point = test::uniform(random, 2, 4) * bearing(camera_, before);
      const Eigen::Vector3d in_camera = world_T_now.inverse() * point;
      if (in_camera.z() < 0.5) continue;
      const Eigen::Vector2d now = project(camera_, in_camera);
      const double angle = test::uniform(random, 0, 2 * M_PI);
      Track track = trackAt(id, now.cast<float>(), Eigen::Vector2d(std::cos(angle), std::sin(angle)).cast<float>());
      track.keyframe = 0;
      track.keyframe_images = view_.keyframes[0].images;
      track.keyframe_pixel = before.cast<float>();
      if (static_cast<int>(tracks_.size()) < mapped) view_.points.push_back(viewPoint(view_, id, 0, point));
      tracks_.push_back(track);
    }
    held_.world_R_camera = (world_T_now.rotation * rotationExp({0.004, -0.003, 0.002})).normalized();
  }

  std::optional<FramePose> pose() const {
    return orientationOnly(camera_, view_, tracks_, held_, FramePoseOptions(), options_,
                           std::pmr::get_default_resource());
  }

  const Camera camera_ = smallCamera();
  MapView view_;
  std::vector<Track> tracks_;
  HeldCamera held_;
  OrientationOnlyOptions options_;
};

const Pose turned_camera{rotationExp({0.01, 0.15, -0.02}), Eigen::Vector3d::Zero()};

TEST_F(OrientationOnly, ATurnIsMeasuredAndThePositionStays) {
  follow(turned_camera, 0);
  const auto found = pose();
  ASSERT_TRUE(found);
  EXPECT_LT(rotationAngle(found->result.world_T_camera.rotation, turned_camera.rotation), 2e-3);
  EXPECT_LT(found->result.world_T_camera.translation.norm(), 0.01);
  EXPECT_EQ(found->result.inlier_count, 0);
  EXPECT_TRUE(found->track_of_observation.empty());
}

// What cannot be told from a turn is in the covariance.
TEST_F(OrientationOnly, AMotionThatIsNotSeenIsInTheCovariance) {
  const Pose moved{turned_camera.rotation, {0.03, 0.01, -0.02}};
  follow(moved, 0);
  const auto found = pose();
  ASSERT_TRUE(found);
  const Pose error = found->result.world_T_camera.inverse() * moved;
  for (int i = 0; i < 3; ++i) {
    EXPECT_LT(std::abs(error.translation[i]), 3 * std::sqrt(found->result.covariance(i, i))) << i;
    EXPECT_LT(std::abs(rotationLog(error.rotation)[i]), 3 * std::sqrt(found->result.covariance(i + 3, i + 3))) << i;
  }
}

TEST_F(OrientationOnly, ThePositionIsLessCertainTheLongerItIsHeld) {
  follow(turned_camera, 0);
  double before = 0;
  for (const int frames : {1, 2, 4}) {
    held_.seconds_ago = frames * turning_frame_s;
    const auto found = pose();
    ASSERT_TRUE(found) << frames;
    const double variance = found->result.covariance.topLeftCorner<3, 3>().trace();
    EXPECT_GT(variance, 2 * before);
    before = variance;
  }
  held_.covariance.topLeftCorner<3, 3>() = Eigen::Matrix3d::Identity();  // a third of the distance
  EXPECT_FALSE(pose());
}

// Few of them leave the map's own pose uncertain; with the rest of the tracks they still tell the position.
TEST_F(OrientationOnly, TheMapDecidesWhereItCan) {
  const Pose moved{turned_camera.rotation, {0.06, -0.02, 0.03}};
  follow(moved, 40);
  const auto found = pose();
  ASSERT_TRUE(found);
  EXPECT_LT((found->result.world_T_camera.translation - moved.translation).norm(), 0.005);
  EXPECT_EQ(found->track_of_observation.size(), 40U);
  EXPECT_EQ(found->result.inliers.size(), 40U);
  EXPECT_GT(found->result.inlier_count, 35);
}

TEST_F(OrientationOnly, WhatDoesNotTurnTogetherIsNoPose) {
  follow(turned_camera, 0);
  test::Random random(6);
  for (std::size_t i = 0; i < tracks_.size(); i += 2) {
    tracks_[i].pixel += Eigen::Vector2d(test::uniform(random, -60, 60), test::uniform(random, -60, 60)).cast<float>();
  }
  EXPECT_FALSE(pose());
}

TEST_F(OrientationOnly, AMapThatContradictsIsNoPose) {
  follow(turned_camera, 60);
  for (std::size_t i = 0; i < view_.points.size(); ++i) {
    if (i % 3 != 0) view_.points[i].host_bearing = bearing(camera_, {310 - 5.0 * static_cast<double>(i), 20});
  }
  EXPECT_FALSE(pose());
}

TEST_F(OrientationOnly, TooFewTracksAreNoPose) {
  follow(turned_camera, 0, options_.fewest_tracks - 1);
  EXPECT_FALSE(pose());
}

TEST_F(OrientationOnly, NothingWhereHardlyAnyOfTheLastFramesTracksAreLeft) {
  follow(turned_camera, 0);
  held_.followed_share = 1.1 * options_.least_followed_share;
  EXPECT_TRUE(pose());
  held_.followed_share = 0.9 * options_.least_followed_share;
  EXPECT_FALSE(pose());
}

TEST_F(OrientationOnly, NothingAfterAGap) {
  follow(turned_camera, 0);
  held_.seconds_ago = 1.1 * options_.longest_gap_s;
  EXPECT_FALSE(pose());
}

TEST_F(OrientationOnly, NothingWhereItIsOff) {
  follow(turned_camera, 0);
  options_.enabled = false;
  EXPECT_FALSE(pose());
}

}  // namespace
}  // namespace edgeslam
