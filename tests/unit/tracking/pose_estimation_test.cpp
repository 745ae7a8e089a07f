// P16: the pose of a frame from its tracks' map points, from the prediction or by resectioning.
#include "tracking/pose_estimation.h"

#include <gtest/gtest.h>

#include "unit/adjustment/synthetic_scene.h"
#include "unit/tracking/textured_plane.h"

namespace edgeslam {
namespace {

// Points of a scene with depth, half of them hosted in each of two keyframes, and the tracks that see them.
class PoseEstimation : public ::testing::Test {
 protected:
  PoseEstimation() {
    view_.initialised = true;
    view_.keyframes = {{0, Pose(), nullptr}, {1, {rotationExp({0.02, -0.05, 0.01}), {0.3, 0, 0.1}}, nullptr}};
    test::Random random(3);
    for (PointId id = 0; id < 120; ++id) {
      const Eigen::Vector2d pixel = test::randomPixel(random, camera_);
      const Eigen::Vector3d point = truth_ * (test::uniform(random, 1.5, 5) * bearing(camera_, pixel));
      if (id % 4 != 3) view_.points.push_back(viewPoint(view_, id, static_cast<KeyframeId>(id % 2), point));
      const double angle = test::uniform(random, 0, 2 * M_PI);
      Track track = trackAt(id, pixel.cast<float>(), Eigen::Vector2d(std::cos(angle), std::sin(angle)).cast<float>());
      if (id % 3 == 0) {
        track.corner = true;
        track.sigma_normal = track.sigma_tangent = 0.2f;
      } else {  // slid along its edge
        const Eigen::Vector2f tangent(-track.normal.y(), track.normal.x());
        track.pixel += static_cast<float>(test::uniform(random, -3, 3)) * tangent;
      }
      tracks_.push_back(track);
    }
  }

  void expectTruth(const FramePose& pose, double translation = 1e-3, double rotation = 1e-3) const {
    ASSERT_TRUE(pose.result.converged);
    EXPECT_LT((pose.result.world_T_camera.translation - truth_.translation).norm(), translation);
    EXPECT_LT(rotationAngle(pose.result.world_T_camera.rotation, truth_.rotation), rotation);
  }

  const Camera camera_ = smallCamera();
  const Pose truth_{rotationExp({-0.03, 0.08, 0.05}), {0.4, -0.1, 0.2}};
  MapView view_;
  std::vector<Track> tracks_;
};

TEST_F(PoseEstimation, FindsThePoseFromAPredictionNearBy) {
  test::Random random(4);
  const FramePose pose =
      estimatePose(camera_, view_, tracks_, test::perturbed(random, truth_, 0.05, 0.03), FramePoseOptions());
  expectTruth(pose);
  EXPECT_FALSE(pose.by_resectioning);
  EXPECT_EQ(pose.result.inlier_count, 90);
}

TEST_F(PoseEstimation, TellsWhichTracksHadAMapPoint) {
  const FramePose pose = estimatePose(camera_, view_, tracks_, truth_, FramePoseOptions());
  ASSERT_EQ(pose.track_of_observation.size(), view_.points.size());
  ASSERT_EQ(pose.result.inliers.size(), view_.points.size());
  for (std::size_t i = 0; i < view_.points.size(); ++i) {
    EXPECT_EQ(tracks_[static_cast<std::size_t>(pose.track_of_observation[i])].id, view_.points[i].id);
  }
}

TEST_F(PoseEstimation, OutliersAreNamed) {
  for (std::size_t i = 0; i < tracks_.size(); i += 10) tracks_[i].pixel += 30 * tracks_[i].normal;
  const FramePose pose = estimatePose(camera_, view_, tracks_, truth_, FramePoseOptions());
  expectTruth(pose, 0.01, 0.01);
  for (std::size_t i = 0; i < pose.track_of_observation.size(); ++i) {
    EXPECT_EQ(pose.result.inliers[i] == 0, pose.track_of_observation[i] % 10 == 0) << pose.track_of_observation[i];
  }
}

PosePrior priorAt(const Pose& pose, double sigma) { return {pose, Matrix6d::Identity() / (sigma * sigma)}; }

TEST_F(PoseEstimation, WhatIsKnownBeforehandTellsWhatUprightEdgesDoNot) {
  for (Track& track : tracks_) {
    track.normal = {1, 0};
    track.corner = false;
    track.sigma_normal = 0.2f;
    track.sigma_tangent = unknown_along;
    if (const ViewPoint* point = findPoint(view_, track.id)) {
      track.pixel = project(camera_, truth_.inverse() * worldPosition(view_, *point)).cast<float>();
      track.pixel.y() += 4;  // all of them slide along
    }
  }
  const Pose start{truth_.rotation, truth_.translation + Eigen::Vector3d(0, 0.02, 0)};
  const auto estimate = [&](const PosePrior& prior) {
    return estimatePose(camera_, view_, tracks_, start, {}, std::pmr::get_default_resource(), {}, prior);
  };
  const FramePose with = estimate(priorAt(truth_, 0.002)), without = estimate({});
  expectTruth(with, 0.004, 0.004);
  const auto leastCertain = [](const FramePose& pose) {
    return pose.result.converged ? largestDeviation(pose.result.covariance, 1) : INFINITY;
  };
  EXPECT_LT(leastCertain(with), 0.003);
  EXPECT_GT(leastCertain(without), 3 * leastCertain(with));
}

TEST_F(PoseEstimation, WhatWasKnownWronglyIsOutvoted) {
  for (Track& track : tracks_) {
    const ViewPoint* point = findPoint(view_, track.id);
    if (point) track.pixel = project(camera_, truth_.inverse() * worldPosition(view_, *point)).cast<float>();
  }
  const Pose wrong{truth_.rotation, truth_.translation + Eigen::Vector3d(0.5, 0.3, 0)};
  const FramePose pose =
      estimatePose(camera_, view_, tracks_, wrong, {}, std::pmr::get_default_resource(), {}, priorAt(wrong, 1e-4));
  expectTruth(pose);
  EXPECT_TRUE(pose.by_resectioning);
}

TEST_F(PoseEstimation, AFailingPredictionIsReplacedByResectioning) {
  for (Track& track : tracks_) {  // resectioning takes pixels as they are
    const ViewPoint* point = findPoint(view_, track.id);
    if (point) track.pixel = project(camera_, truth_.inverse() * worldPosition(view_, *point)).cast<float>();
  }
  const Pose far_off{truth_.rotation * rotationExp({0, 1.2, 0}), truth_.translation + Eigen::Vector3d(2, 0, -1)};
  const FramePose pose = estimatePose(camera_, view_, tracks_, far_off, FramePoseOptions());
  EXPECT_TRUE(pose.by_resectioning);
  expectTruth(pose);
  const FramePose again = estimatePose(camera_, view_, tracks_, far_off, FramePoseOptions());
  EXPECT_EQ(pose.result.world_T_camera.translation, again.result.world_T_camera.translation);
}

// The flat map of a start is not the scene: a pose that fits it from anywhere would be an accident.
TEST_F(PoseEstimation, BeforeTheMapStandsThereIsNoResectioning) {
  view_.initialised = false;
  const Pose far_off{truth_.rotation * rotationExp({0, 1.2, 0}), truth_.translation + Eigen::Vector3d(2, 0, -1)};
  EXPECT_FALSE(estimatePose(camera_, view_, tracks_, far_off, FramePoseOptions()).by_resectioning);
}

TEST_F(PoseEstimation, AFlatViewSeenFromWhereItWasMadeGivesThatPose) {
  TrackedFrame first;
  for (const Track& track : tracks_) {
    PointObservation observation;
    observation.point = track.id;
    observation.bearing = bearing(camera_, track.pixel.cast<double>());
    first.observations.push_back(observation);
  }
  const FramePose pose = estimatePose(camera_, flatView(first), tracks_,
                                      {rotationExp({0, 0.02, 0.01}), {0.02, -0.01, 0.01}}, FramePoseOptions());
  ASSERT_TRUE(pose.result.converged);
  EXPECT_LT(pose.result.world_T_camera.translation.norm(), 1e-3);
  EXPECT_LT(rotationAngle(pose.result.world_T_camera.rotation, Eigen::Quaterniond::Identity()), 1e-3);
}

TEST_F(PoseEstimation, ADepthThatIsNotKnownWeighsLessAlongItsRay) {
  // Half of the points have a wrong depth, and say so.
  for (std::size_t i = 0; i < view_.points.size(); i += 2) {
    view_.points[i].inverse_depth *= 1.4;
    view_.points[i].inverse_depth_sigma = 0.4 * view_.points[i].inverse_depth;
  }
  FramePoseOptions options;
  const FramePose honest = estimatePose(camera_, view_, tracks_, truth_, options);
  for (ViewPoint& point : view_.points) point.inverse_depth_sigma = 1e-6;
  const FramePose overconfident = estimatePose(camera_, view_, tracks_, truth_, options);
  ASSERT_TRUE(honest.result.converged);
  const auto error = [&](const FramePose& pose) {
    return (pose.result.world_T_camera.translation - truth_.translation).norm();
  };
  EXPECT_LT(error(honest), 0.02);
  EXPECT_LT(error(honest), error(overconfident) + 1e-6);
}

TEST_F(PoseEstimation, TooFewPointsGiveNoPose) {
  view_.points.resize(8);
  EXPECT_FALSE(estimatePose(camera_, view_, tracks_, truth_, FramePoseOptions()).result.converged);
  view_.points.clear();
  const FramePose none = estimatePose(camera_, view_, tracks_, truth_, FramePoseOptions());
  EXPECT_FALSE(none.result.converged);
  EXPECT_TRUE(none.track_of_observation.empty());
}

// The map's points are all on one side of the image. Tracks without depth on the other tell more of the pose.
TEST_F(PoseEstimation, TracksWithoutDepthHelpAcrossTheirEpipolarLines) {
  test::Random random(11);
  FramePoseOptions without, with;
  without.unmapped_depth_sigma = 0;
  double error_alone = 0, error_helped = 0;
  for (int trial = 0; trial < 20; ++trial) {
    MapView few = view_;
    few.points.clear();
    for (const ViewPoint& point : view_.points) {
      const Eigen::Vector2d pixel = project(camera_, truth_.inverse() * worldPosition(view_, point));
      if (pixel.x() < 0.3 * camera_.width) few.points.push_back(point);
    }
    std::vector<Track> tracks;
    for (Track track : tracks_) {
      const ViewPoint* point = findPoint(view_, track.id);
      if (!point) continue;
      const Eigen::Vector3d position = worldPosition(view_, *point);
      track.keyframe = 1;
      track.keyframe_images = std::make_shared<FrameImages>();
      track.keyframe_pixel = project(camera_, view_.keyframes[1].world_T_camera.inverse() * position).cast<float>();
      track.sigma_normal = track.sigma_tangent = 0.5f;
      track.pixel = (project(camera_, truth_.inverse() * position) +
                     Eigen::Vector2d(test::gaussian(random, 0.5), test::gaussian(random, 0.5)))
                        .cast<float>();
      tracks.push_back(track);
    }
    const FramePose alone = estimatePose(camera_, few, tracks, truth_, without);
    const FramePose helped = estimatePose(camera_, few, tracks, truth_, with);
    ASSERT_TRUE(alone.result.converged && helped.result.converged);
    EXPECT_EQ(helped.result.inliers.size(), few.points.size());
    EXPECT_LE(helped.result.inlier_count, static_cast<int>(few.points.size()));
    EXPECT_LT(helped.result.covariance.trace(), alone.result.covariance.trace());
    error_alone += (alone.result.world_T_camera.translation - truth_.translation).squaredNorm();
    error_helped += (helped.result.world_T_camera.translation - truth_.translation).squaredNorm();
  }
  EXPECT_LT(error_helped, 0.7 * error_alone);
}

TEST(LargestDeviation, IsThatAlongTheWorstDirectionOfEither) {
  const Eigen::Matrix3d turn = rotationExp({0.4, -1.1, 0.7}).toRotationMatrix();
  const auto block = [&](double a, double b, double c) {
    return Eigen::Matrix3d(turn * Eigen::Vector3d(a * a, b * b, c * c).asDiagonal() * turn.transpose());
  };
  Matrix6d covariance = Matrix6d::Zero();
  covariance.topLeftCorner<3, 3>() = block(0.2, 0.01, 0.4);
  covariance.bottomRightCorner<3, 3>() = block(0.03, 0.15, 0.02);
  EXPECT_NEAR(largestDeviation(covariance, 2), 0.2, 1e-9);
  EXPECT_NEAR(largestDeviation(covariance, 20), 0.15, 1e-9);
}

}  // namespace
}  // namespace edgeslam
