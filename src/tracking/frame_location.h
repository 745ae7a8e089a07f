// Where a frame was taken from (section 3.1, P5, P6, and 3.4.1, P16): the last frame's tracks are followed into it, and
// its pose is estimated from those that are in the map.
#pragma once

#include <memory_resource>
#include <optional>
#include <string>
#include <vector>

#include "edges/point_accuracy.h"
#include "flow/optical_flow.h"
#include "image/hidden_levels.h"
#include "map/map_view.h"
#include "tracking/edge_lock.h"
#include "tracking/followed_frame.h"
#include "tracking/orientation_only.h"
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
  OrientationOnlyOptions orientation_only;
  int coarse_level = 2;    // of the pyramid: the finest on which tracks are followed into what is blurred
  int outlier_frames = 4;  // a track whose map point misses the pose so often in a row is dropped
};

// What is known before a frame is located.
struct LocationPrior {
  Pose world_T_predicted;     // from motion alone ...
  PosePrior known;            // ... where that is known well enough to count beside what is measured
  bool regains = false;       // it is blurred or lost, or the frame before was, or was found again by others
  bool knows_motion = false;  // the two frames before were located in this map
  bool coarsely = false;      // the frame shows nothing fine: points count for as much less as their level is coarser
  const PointAccuracy& accuracy;  // of what is measured in this frame
  RowMotion motion;               // tells how the camera moves while its rows are read
};

// What a frame's tracks came to in the map, be the pose believed or not.
struct LocationFigures {
  int followed = 0;         // tracks found in the frame ...
  int tracks = 0;           // ... of so many
  bool has_pose = false;    // the map points among them give one
  int in_view = 0;          // map points among them
  int agree = 0;            // of these, with the pose
  int asked = 0;            // so many had to agree
  double deviation = 0;     // of the pose, as it is judged (pose_acceptance.h) ...
  double most_allowed = 0;  // ... which had to be less
  bool is_leap = false;     // off the motion that was expected, with too few tracks followed
};

// Why no pose was found that can be believed, in words, in place of what is in `reason`.
void describe(const LocationFigures& figures, std::string& reason);

class FrameLocation {
 public:
  FrameLocation(const Camera& camera, const LocationOptions& options);

  // For frames to come: it was found to be another one.
  void setCamera(const Camera& camera);

  // Fills the tracks, the pose and what agrees with it of `frame`, whose images and edges are there; `last` was located
  // in `view`. False where no pose is found that can be believed: `figures` say why. `memory`: what it needs on the
  // way.
  bool locate(const FollowedFrame& last, const MapView& view, const LocationPrior& prior, FollowedFrame& frame,
              LocationFigures& figures, std::pmr::memory_resource& memory, StageClock& clock) const;

 private:
  Pose alignImages(const FollowedFrame& last, const AlignmentPoints& points, const Pose& world_T_predicted,
                   const FollowedFrame& frame, std::pmr::memory_resource& memory) const;
  std::optional<FramePose> poseInMap(const MapView& view, const LocationPrior& prior, const Pose& world_T_predicted,
                                     const AcceptanceContext& context, FollowedFrame& frame, LocationFigures& figures,
                                     std::pmr::memory_resource& memory, StageClock& clock) const;
  void countOutliers(const FramePose& pose, bool map_stands, std::vector<Track>& tracks) const;

  Camera camera_;
  LocationOptions options_;
  std::vector<RotationGrid> rotation_grids_;
  HiddenLevels hidden_from_alignment_, hidden_from_flow_;
};

}  // namespace edgeslam
