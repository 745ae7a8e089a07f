// The pixel of a track is refined against its patch in a keyframe.
#include "tracking/patch_refinement.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "unit/edges/synthetic_image.h"
#include "unit/tracking/textured_plane.h"

namespace edgeslam {
namespace {

// Where the pixel's neighbour in the current image is seen in the keyframe, for a patch all at the same distance.
Eigen::Vector2d backInKeyframe(const Camera& camera, const Pose& camera_T_keyframe, const Eigen::Vector2d& centre,
                               double depth, const Eigen::Vector2d& offset) {
  // Newton on the forward transfer, which is what the warp linearises.
  const auto forward = [&](const Eigen::Vector2d& pixel) {
    return project(camera, camera_T_keyframe * Eigen::Vector3d(bearing(camera, pixel) * depth));
  };
  const Eigen::Vector2d wanted = forward(centre) + offset;
  Eigen::Vector2d pixel = centre;
  for (int i = 0; i < 20; ++i) {
    constexpr double h = 1e-3;
    Eigen::Matrix2d j;
    j.col(0) = (forward(pixel + Eigen::Vector2d(h, 0)) - forward(pixel - Eigen::Vector2d(h, 0))) / (2 * h);
    j.col(1) = (forward(pixel + Eigen::Vector2d(0, h)) - forward(pixel - Eigen::Vector2d(0, h))) / (2 * h);
    pixel += j.inverse() * (wanted - forward(pixel));
  }
  return pixel - centre;
}

TEST(PatchRefinement, TheWarpIsWhatDirectProjectionSays) {
  const Camera camera = smallCamera();
  const Pose poses[] = {Pose(),
                        {rotationExp({0, 0, 0.5}), {0, 0, 0}},
                        {rotationExp({0, 0, 0}), {0, 0, 0.7}},
                        {rotationExp({0.05, -0.1, 0.3}), {0.2, -0.1, -0.4}}};
  for (const Pose& camera_T_keyframe : poses) {
    for (const Eigen::Vector2f& pixel : {Eigen::Vector2f(161, 118), {90, 60}, {230, 180}}) {
      const Eigen::Matrix2f warp = keyframeWarp(camera, camera_T_keyframe, pixel, 2.0);
      for (const Eigen::Vector2d& offset : {Eigen::Vector2d(5, 0), {0, 5}, {-4, 3}}) {
        const Eigen::Vector2d expected = backInKeyframe(camera, camera_T_keyframe, pixel.cast<double>(), 2.0, offset);
        EXPECT_LT((warp.cast<double>() * offset - expected).norm(), 0.1) << pixel.transpose();
      }
    }
  }
}

TEST(PatchRefinement, TheWarpOfAnUnmovedCameraIsNone) {
  EXPECT_LT((keyframeWarp(smallCamera(), Pose(), {100, 90}, 3.0) - Eigen::Matrix2f::Identity()).norm(), 1e-5f);
}

class Refinement : public ::testing::Test {
 protected:
  Refinement() {
    view_.initialised = true;
    view_.keyframes = {{0, Pose(), nullptr}};
    for (int y = 50; y <= 190; y += 14) {
      for (int x = 60; x <= 260; x += 14) {
        Track track = trackAt(static_cast<PointId>(tracks_.size()), Eigen::Vector2f(x, y));
        track.keyframe = 0;
        track.keyframe_images = keyframe_images_;
        const Eigen::Vector3d point = plane_.seenAt(camera_, Pose(), Eigen::Vector2d(x, y));
        view_.points.push_back(viewPoint(view_, track.id, 0, point));
        tracks_.push_back(track);
      }
    }
  }

  Eigen::Vector2f truth(const Track& track, const Pose& pose) const {
    return project(camera_, pose.inverse() * worldPosition(view_, *findPoint(view_, track.id))).cast<float>();
  }

  // Renders what the camera sees from `pose` and starts every track `off` from its true place.
  void look(const Pose& pose, const Eigen::Vector2f& off) {
    pose_ = pose;
    images_ = imagesOf(plane_.render(camera_, pose));
    for (Track& track : tracks_) track.pixel = truth(track, pose) + off;
  }

  void refine() { refineTracks(camera_, view_, *images_, pose_, 2.0, options_, tracks_); }

  const Camera camera_ = smallCamera();
  const TexturedPlane plane_{SmoothTexture(41, 10, 60)};
  std::shared_ptr<const FrameImages> keyframe_images_ = imagesOf(plane_.render(camera_, Pose()));
  std::shared_ptr<const FrameImages> images_;
  Pose pose_;
  MapView view_;
  std::vector<Track> tracks_;
  RefinementOptions options_;
};

TEST_F(Refinement, FindsTheKeyframesPatchUnderRotationAndScale) {
  look({rotationExp({0, 0, 0.35}), {0.05, 0.02, 0.5}}, {0.3f, -0.2f});
  const std::size_t before = tracks_.size();
  refine();
  EXPECT_GT(static_cast<double>(tracks_.size()), 0.9 * static_cast<double>(before));
  std::vector<float> errors;
  for (const Track& track : tracks_) errors.push_back((track.pixel - truth(track, pose_)).norm());
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.05f);
  EXPECT_LT(errors[errors.size() * 9 / 10], 0.25f);
}

TEST_F(Refinement, DoesNotDriftFromFrameToFrame) {
  for (int frame = 1; frame <= 12; ++frame) {
    const Pose pose{rotationExp({0, 0, 0.02 * frame}), {0.01 * frame, 0, 0.02 * frame}};
    std::vector<Eigen::Vector2f> carried;
    for (const Track& track : tracks_) {  // what flow would hand on, with an error of its own
      carried.emplace_back(track.pixel - truth(track, pose_) + Eigen::Vector2f(0.1f, 0.1f));
    }
    pose_ = pose;
    images_ = imagesOf(plane_.render(camera_, pose));
    for (std::size_t i = 0; i < tracks_.size(); ++i) tracks_[i].pixel = truth(tracks_[i], pose) + carried[i];
    refine();
  }
  std::vector<float> errors;
  for (const Track& track : tracks_) errors.push_back((track.pixel - truth(track, pose_)).norm());
  std::sort(errors.begin(), errors.end());
  ASSERT_GT(errors.size(), 100U);
  EXPECT_LT(errors[errors.size() / 2], 0.05f) << "12 frames of 0.14 px are 1.7 px";
}

TEST_F(Refinement, ATrackWithoutDepthIsRefinedAtTheScenesDepth) {
  look({rotationExp({0, 0, 0.2}), {0, 0, 0.3}}, {0.4f, -0.3f});
  const MapView whole = view_;
  view_.points.clear();
  refine();
  ASSERT_GT(tracks_.size(), 100U);
  view_ = whole;
  std::vector<float> errors;
  for (const Track& track : tracks_) errors.push_back((track.pixel - truth(track, pose_)).norm());
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.08f);
}

TEST_F(Refinement, WhatNoLongerLooksLikeItsPatchGoes) {
  look(Pose(), {0, 0});
  images_ = imagesOf(TexturedPlane{SmoothTexture(42, 6, 20)}.render(camera_, Pose()));
  const std::size_t before = tracks_.size();
  refine();
  EXPECT_LT(static_cast<double>(tracks_.size()), 0.1 * static_cast<double>(before));
}

TEST_F(Refinement, AMoveAcrossTheEdgeThatIsTooLongIsNotBelieved) {
  options_.least_correlation = -1;
  options_.iterations = 30;
  tracks_.resize(1);
  const cv::Mat edge = renderLine({320, 240}, lineThrough(160, 120, 0));
  keyframe_images_ = imagesOf(edge);
  tracks_[0] = trackAt(0, {160, 120});
  tracks_[0].keyframe = 0;
  tracks_[0].keyframe_images = images_ = keyframe_images_;
  tracks_[0].pixel = {162.5f, 120};
  std::vector<Track> tracks = tracks_;
  refine();
  EXPECT_TRUE(tracks_.empty());
  tracks_ = tracks;
  tracks_[0].pixel = {161.5f, 120};
  refine();
  ASSERT_EQ(tracks_.size(), 1U);
  EXPECT_NEAR(tracks_[0].pixel.x(), 160, 0.05);
}

TEST_F(Refinement, APatchThatBecameAnotherSizeGoes) {
  look(Pose(), {0, 0});
  pose_ = {Eigen::Quaterniond::Identity(), {0, 0, 1.4}};  // everything more than three times as large
  refine();
  EXPECT_TRUE(tracks_.empty());
}

TEST_F(Refinement, ATrackWithoutAKeyframePatchStaysAsItIs) {
  look(Pose(), {0.4f, -0.3f});
  tracks_[0].keyframe_images = nullptr;
  tracks_[1].keyframe = 5;  // that the view does not have yet
  const Eigen::Vector2f first = tracks_[0].pixel, second = tracks_[1].pixel;
  refine();
  EXPECT_EQ(tracks_[0].id, 0);
  EXPECT_EQ(tracks_[0].pixel, first);
  EXPECT_EQ(tracks_[1].id, 1);
  EXPECT_EQ(tracks_[1].pixel, second);
}

TEST_F(Refinement, MayBeSwitchedOff) {
  look(Pose(), {0.4f, -0.3f});
  options_.enabled = false;
  const Eigen::Vector2f first = tracks_[0].pixel;
  refine();
  EXPECT_EQ(tracks_[0].pixel, first);
}

}  // namespace
}  // namespace edgeslam
