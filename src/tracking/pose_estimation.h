// The pose of a frame from its tracks' map points: robust Gauss-Newton from the prediction; EPnP in RANSAC (P16) where
// that fails.
#pragma once

#include <vector>

#include "adjustment/pose_adjustment.h"
#include "map/map_view.h"
#include "tracking/track.h"

namespace edgeslam {

struct FramePose {
  PoseResult result;
  std::vector<int> track_of_observation;  // index into the tracks of each entry of result.inliers
  bool by_resectioning = false;
};

FramePose estimatePose(const Camera& camera, const MapView& view, const std::vector<Track>& tracks,
                       const Pose& world_T_predicted, const PoseOptions& options);

}  // namespace edgeslam
