// Where a frame was taken from (section 3.1, P5, P6, and 3.4.1, P16): the last frame's tracks are followed into it, and
// its pose is estimated from those that are in the map.
#pragma once

#include <memory_resource>
#include <vector>

#include "edges/point_accuracy.h"
#include "flow/optical_flow.h"
#include "map/map_view.h"
#include "tracking/edge_lock.h"
#include "tracking/followed_frame.h"
#include "tracking/patch_refinement.h"
#include "tracking/point_following.h"
#include "tracking/pose_acceptance.h"
#include "tracking/rotation_alignment.h"
#include "tracking/sparse_alignment.h"
#include "tracking/stage_times.h"

namespace edgeslam {

struct LocationOptions {
  FlowOptions flow;
  FramePoseOptions pose;
  RefinementOptions refinement;
  EdgeLockOptions edge_lock;
  SparseAlignmentOptions alignment;
  AcceptanceOptions acceptance;
  int outlier_frames = 4;  // a track whose map point misses the pose so often in a row is dropped
};

// What is known before a frame is located.
struct LocationPrior {
  Pose world_T_predicted;         // from motion alone
  bool regains = false;           // the frame before was blurred or lost
  const PointAccuracy& accuracy;  // of what is measured in this frame
  RowMotion motion;               // tells how the camera moves while its rows are read
};

class FrameLocation {
 public:
  FrameLocation(const Camera& camera, const LocationOptions& options);

  // Fills the tracks, the pose and what agrees with it of `frame`, whose images and edges are there; `last` was located
  // in `view`. False where no pose is found that can be believed. `memory`: what it needs on the way.
  bool locate(const FollowedFrame& last, const MapView& view, const LocationPrior& prior, FollowedFrame& frame,
              std::pmr::memory_resource& memory, StageClock& clock) const;

 private:
  Pose alignImages(const FollowedFrame& last, const AlignmentPoints& points, const Pose& world_T_predicted,
                   const FollowedFrame& frame, std::pmr::memory_resource& memory) const;
  void countOutliers(const FramePose& pose, bool map_stands, std::vector<Track>& tracks) const;

  Camera camera_;
  LocationOptions options_;
  std::vector<RotationGrid> rotation_grids_;
};

}  // namespace edgeslam
