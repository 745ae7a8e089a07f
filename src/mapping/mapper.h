// Mapping: every keyframe (section 3.4 of the paper). Owns the map; takes tracked frames, gives map views.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mapping/culling.h"
#include "mapping/global_adjustment.h"
#include "mapping/initialisation.h"
#include "mapping/local_adjustment.h"
#include "mapping/new_points.h"
#include "mapping/track_loss_recovery.h"
#include "mapping/view_of_map.h"

namespace edgeslam {

struct MapperOptions {
  InitialisationOptions initialisation;
  NewPointOptions new_points;
  LocalAdjustmentOptions local_adjustment;
  CullingOptions culling;
  GlobalAdjustmentOptions global_adjustment;
  int old_keyframes = 20;          // a part of the map is old so many keyframes after it was left ...
  int old_points = 20;             // ... and met again with so many of its points
  int iterations_after_loop = 40;  // of the adjustment of the whole map: a closed loop leaves it far from its minimum
  int global_interval_keyframes = 25;  // P20: from one global adjustment to the next ...
  double global_interval_s = 25;       // ... at the latest
  bool recovery_enabled = true;
  RecoveryOptions recovery;
  ViewOptions view;
};

class Mapper {
 public:
  Mapper(const Camera& camera, const MapperOptions& options)
      : camera_(camera), options_(options), initialisation_(camera, options.initialisation) {}

  // Before the first frame: goes on with a map made earlier, of the same camera.
  void goOnWith(Map map);

  // Takes over a frame. Returns a new view of the map where it changed.
  std::optional<MapView> add(const TrackedFrame& frame);

  // P21: the lost frame's tracks, all without pose, and the last two keyframes. Where it is found the frame becomes a
  // keyframe and its tracks map points; `view()` then shows it.
  RecoveryResult recover(const TrackedFrame& lost);
  // P20 where it is due, or at once (after a loop was closed). True where the map changed.
  bool adjustAll(bool at_once);
  // True where the latest keyframe sees points of a part of the map left long ago, as none of the keyframes before it
  // did: map reuse closed a loop by itself, and drift is to be shared out.
  bool metOldMap();
  // For corrections of the map as a whole (loop closing).
  template <typename Correct>
  void correct(const Correct& apply) {
    apply(map_);
    ++version_;
  }
  // Keyframes taken out of the map since this was last asked, in that order.
  std::vector<CulledKeyframe> takeCulled() { return std::exchange(culled_, {}); }
  // The map as tracking gets to see it; `centre` -1: around the latest keyframe.
  MapView view(KeyframeId centre = -1) const;

  bool initialised() const { return initialised_; }
  const Map& map() const { return map_; }
  // How the map came to be, in words.
  const std::string& initialisationDescription() const { return description_; }
  // Poses of the frames before the map stood: (frame index, world_T_camera with keyframe 0 as it is now).
  std::vector<std::pair<std::int64_t, Pose>> earlyPoses() const;

 private:
  void addKeyframe(const TrackedFrame& frame);

  Camera camera_;
  MapperOptions options_;
  Initialisation initialisation_;
  Map map_;
  Candidates candidates_;
  std::string description_;
  bool initialised_ = false;
  std::uint64_t version_ = 0;
  std::int64_t origin_frame_ = -1;
  KeyframeId last_meeting_ = -1;     // latest keyframe that met an old part of the map
  KeyframeId last_global_ = 0;       // latest keyframe at the last global adjustment ...
  std::int64_t last_global_ns_ = 0;  // ... and its time
  std::vector<CulledKeyframe> culled_;
  std::vector<std::pair<std::int64_t, Pose>> early_poses_;  // keyframe0_T_camera
};

}  // namespace edgeslam
