// P16: of two poses that points agree with, which one a frame gets: something that moves may have drawn the first to
// itself.
#include <gtest/gtest.h>

#include <memory>

#include "tracking/pose_estimation.h"
#include "unit/adjustment/synthetic_scene.h"
#include "unit/tracking/textured_plane.h"

namespace edgeslam {
namespace {

// Map points far away, that agree with either of two poses a little apart, and near ones that follow the one or the
// other. Many tracks that are not mapped yet are on the object that moved, and hold the first pose with it.
class PoseChoice : public ::testing::Test {
 protected:
  void see(int far, int static_near, int moved_near) {
    view_.initialised = true;
    view_.keyframes = {{0, Pose(), nullptr}, {1, {Eigen::Quaterniond::Identity(), {0.3, -0.4, 0}}, nullptr}};
    view_.points.clear();
    tracks_.clear();
    test::Random random(3);
    const auto images = std::make_shared<FrameImages>();
    constexpr int unmapped = 200;
    const int mapped = far + static_near + moved_near;
    for (PointId id = 0; id < mapped + unmapped; ++id) {
      const double depth = id < far ? 400 : test::uniform(random, 1.5, 4);
      const Eigen::Vector3d point = depth * bearing(camera_, test::randomPixel(random, camera_));
      const Pose& seen_from = id >= far + static_near ? follows_object_ : truth_;
      Track track = trackAt(id, project(camera_, seen_from.inverse() * point).cast<float>());
      track.corner = true;
      track.sigma_normal = track.sigma_tangent = id < mapped ? 0.5f : 0.05f;
      if (id < mapped) {
        view_.points.push_back(viewPoint(view_, id, 0, point));
        view_.points.back().inverse_depth_sigma = 1e-4 * view_.points.back().inverse_depth;
      } else {
        track.keyframe = static_cast<KeyframeId>(id % 2);
        track.keyframe_images = images;
        const Pose keyframe_T_world = view_.keyframes[track.keyframe].world_T_camera.inverse();
        track.keyframe_pixel = project(camera_, keyframe_T_world * point).cast<float>();
      }
      tracks_.push_back(track);
    }
  }

  FramePose estimated(double huber = FramePoseOptions().huber) const {
    FramePoseOptions options;
    options.huber = huber;
    return estimatePose(camera_, view_, tracks_, follows_object_, options);
  }
  static bool is(const FramePose& pose, const Pose& expected) {
    return pose.result.converged && (pose.result.world_T_camera.translation - expected.translation).norm() < 0.02 &&
           rotationAngle(pose.result.world_T_camera.rotation, expected.rotation) < 0.005;
  }

  const Camera camera_ = smallCamera();
  const Pose truth_{Eigen::Quaterniond::Identity(), {0.3, 0, 0.01}};
  const Pose follows_object_{Eigen::Quaterniond::Identity(), {0.3, 0.25, 0.01}};
  MapView view_;
  std::vector<Track> tracks_;
};

TEST_F(PoseChoice, WhereMostAgreeThePoseStays) {
  see(40, 22, 38);  // 78 with the object's pose
  const FramePose pose = estimated();
  EXPECT_TRUE(is(pose, follows_object_));
  EXPECT_FALSE(pose.by_resectioning);
  EXPECT_NEAR(pose.result.inlier_count, 78, 2);
}

TEST_F(PoseChoice, WhereClearlyMoreAgreeWithAnotherThatOneIsTaken) {
  see(40, 40, 20);  // 60 with the object's pose, 80 with the truth
  const FramePose pose = estimated();
  EXPECT_TRUE(pose.by_resectioning);
  EXPECT_TRUE(is(pose, truth_));
  EXPECT_NEAR(pose.result.inlier_count, 80, 4);
}

TEST_F(PoseChoice, WhereHardlyMoreAgreeWithAnotherTheFirstStays) {
  see(40, 32, 28);  // 68 against 72
  const FramePose pose = estimated();
  EXPECT_FALSE(pose.by_resectioning);
  EXPECT_TRUE(is(pose, follows_object_));
  EXPECT_NEAR(pose.result.inlier_count, 68, 2);
}

// With less than half of the points the first pose is no match for any that has more.
TEST_F(PoseChoice, WhereFewAgreeAnyThatHasMoreIsTaken) {
  see(12, 44, 36);  // 48 of 92 are half; without the far ones there is nothing in common
  const FramePose half = estimated();
  EXPECT_FALSE(half.by_resectioning) << "56 is not clearly more than 48";
  see(0, 52, 44);
  const FramePose fewer = estimated(0.3);  // so that nearly as many others hardly pull
  EXPECT_TRUE(fewer.by_resectioning);
  EXPECT_TRUE(is(fewer, truth_));
}

}  // namespace
}  // namespace edgeslam
