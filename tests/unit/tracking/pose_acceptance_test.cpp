// Which poses are believed.
#include "tracking/pose_acceptance.h"

#include <gtest/gtest.h>

#include "geometry/pose.h"

namespace edgeslam {
namespace {

// A pose that all of 200 map points in view agree with, as many as before, where the motion was expected to be.
class PoseAcceptance : public ::testing::Test {
 protected:
  PoseAcceptance() {
    pose_.track_of_observation.resize(200);
    pose_.result.inlier_count = 200;
    pose_.result.covariance = 1e-8 * Matrix6d::Identity();
    pose_.result.world_T_camera = expected_;
    context_.inliers_before = 200;
    context_.knows_motion = true;
    context_.scene_depth = 4;
    context_.seconds = 0.04;
    context_.world_T_predicted = expected_;
  }

  void move(const Pose& off) { pose_.result.world_T_camera = expected_ * off; }

  const AcceptanceOptions options_;
  const double leap_ = 0.04 * options_.leap_speed;
  const Pose expected_{rotationExp({0.3, -0.8, 0.2}), {1, -2, 0.5}};
  FramePose pose_{std::pmr::get_default_resource()};
  AcceptanceContext context_;
};

TEST_F(PoseAcceptance, APoseThatTheMapAgreesWithIsBelieved) { EXPECT_TRUE(isBelieved(pose_, context_, options_)); }

TEST_F(PoseAcceptance, AfterALossItTakesMoreThanBefore) {
  pose_.result.inlier_count = static_cast<int>(options_.least_inlier_share * 200) + 1;
  EXPECT_TRUE(isBelieved(pose_, context_, options_));
  context_.regains = true;
  EXPECT_FALSE(isBelieved(pose_, context_, options_));
}

TEST_F(PoseAcceptance, AnUncertainPoseIsNotBelieved) {
  const double most = options_.largest_deviation * context_.scene_depth;
  pose_.result.covariance(1, 1) = 1.1 * most * most;
  EXPECT_FALSE(isBelieved(pose_, context_, options_));
}

TEST_F(PoseAcceptance, ALeapTakesMostOfTheTracks) {
  for (const Pose& leap : {Pose{rotationExp({0, 1.2 * leap_, 0}), {0, 0, 0}},
                           Pose{Eigen::Quaterniond::Identity(), {0, 0, -1.2 * leap_ * context_.scene_depth}}}) {
    move(leap);
    context_.followed_share = 1.1 * options_.leap_followed_share;
    EXPECT_TRUE(isBelieved(pose_, context_, options_));
    context_.followed_share = 0.9 * options_.leap_followed_share;
    EXPECT_FALSE(isBelieved(pose_, context_, options_));
  }
}

TEST_F(PoseAcceptance, FewTracksAreNoLeapAsLongAsTheMotionGoesOn) {
  move({rotationExp({0, 0.8 * leap_, 0}), {0.8 * leap_ * context_.scene_depth, 0, 0}});
  context_.followed_share = 0.1;
  EXPECT_TRUE(isBelieved(pose_, context_, options_));
}

TEST_F(PoseAcceptance, WhereNoMotionIsExpectedThereIsNoLeap) {
  move({rotationExp({0, 3 * leap_, 0}), {0, 0, 0}});
  context_.followed_share = 0.1;
  context_.knows_motion = false;
  EXPECT_TRUE(isBelieved(pose_, context_, options_));
}

}  // namespace
}  // namespace edgeslam
