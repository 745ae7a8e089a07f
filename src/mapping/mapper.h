// Mapping: every keyframe (section 3.4 of the paper). Owns the map; takes tracked frames, gives map views.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "map/map_change.h"
#include "mapping/culling.h"
#include "mapping/global_adjustment.h"
#include "mapping/initialisation.h"
#include "mapping/local_adjustment.h"
#include "mapping/map_uncertainty.h"
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
  bool recovery_enabled = true;
  RecoveryOptions recovery;
  ViewOptions view;
  MapUncertaintyOptions uncertainty;
};

class Mapper {
 public:
  Mapper(const Camera& camera, const MapperOptions& options)
      : camera_(camera), options_(options), initialisation_(camera, options.initialisation) {}

  // Before the first frame: continues a map made earlier, of the same camera.
  void goOnWith(Map map);

  // Takes over a frame. True where the map, or what it waits for, changed.
  bool add(const TrackedFrame& frame);

  // P21: the lost frame's tracks, all without pose, and the last two keyframes. Where it is found the frame becomes a
  // keyframe and its tracks map points; `view()` then shows it.
  RecoveryResult recover(const TrackedFrame& lost);
  // What was done to a copy of the map as a whole (P20, P27).
  void apply(const MapChange& change);
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
  std::vector<CulledKeyframe> culled_;
  std::vector<std::pair<std::int64_t, Pose>> early_poses_;  // keyframe0_T_camera
};

}  // namespace edgeslam
