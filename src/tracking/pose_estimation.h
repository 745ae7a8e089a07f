// The pose of a frame from its tracks' map points: robust Gauss-Newton from the prediction; P3P in RANSAC (P16) where
// that fails.
#pragma once

#include <memory_resource>
#include <vector>

#include "adjustment/pose_adjustment.h"
#include "map/map_view.h"
#include "tracking/track.h"

namespace edgeslam {

struct FramePoseOptions : PoseOptions {
  double unmapped_depth_sigma = 2;  // of the depth guessed for a track without one, share of it; 0: it does not help
  double unmapped_weakening = 3;    // their standard deviations count so many times: the map is to decide where it can
};

struct FramePose {
  explicit FramePose(std::pmr::memory_resource* memory) : result(memory), track_of_observation(memory) {}

  PoseResult result;
  std::pmr::vector<int> track_of_observation;  // index into the tracks of each entry of result.inliers
  bool by_resectioning = false;
};

// Tracks without a map point help with what they measure across their epipolar lines; inliers and their count are of
// the map points alone. `prior` counts beside what is measured, but not in a pose that RANSAC begins: where the prior
// is wrong, that one outvotes it.
FramePose estimatePose(const Camera& camera, const MapView& view, const std::vector<Track>& tracks,
                       const Pose& world_T_predicted, const FramePoseOptions& options,
                       std::pmr::memory_resource* memory = std::pmr::get_default_resource(),
                       const RowMotion& motion = {}, const PosePrior& prior = {});

// What is not mapped helps a pose, but says nothing of how much of the map is found again: takes it out of the result.
void keepMapped(FramePose& pose);

// The largest standard deviation of a pose: of its position, as a share of `scene_depth`, or of its rotation [rad].
// `covariance`: of [translation; rotation].
double largestDeviation(const Matrix6d& covariance, double scene_depth);

}  // namespace edgeslam
