// Mapping: every keyframe (section 3.4 of the paper). Owns the map; takes tracked frames, gives map views.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mapping/initialisation.h"
#include "mapping/local_adjustment.h"
#include "mapping/new_points.h"
#include "mapping/view_of_map.h"

namespace edgeslam {

struct MapperOptions {
  InitialisationOptions initialisation;
  NewPointOptions new_points;
  LocalAdjustmentOptions local_adjustment;
  ViewOptions view;
};

class Mapper {
 public:
  Mapper(const Camera& camera, const MapperOptions& options)
      : camera_(camera), options_(options), initialisation_(camera, options.initialisation) {}

  // Takes over a frame. Returns a new view of the map where it changed.
  std::optional<MapView> add(const TrackedFrame& frame);

  bool initialised() const { return initialised_; }
  const Map& map() const { return map_; }
  const std::string& initialisationDescription() const { return initialisation_.description(); }
  // Poses of the frames before the map stood: (frame index, world_T_camera with keyframe 0 as it is now).
  std::vector<std::pair<std::int64_t, Pose>> earlyPoses() const;

 private:
  void addKeyframe(const TrackedFrame& frame);
  MapView view() const;

  Camera camera_;
  MapperOptions options_;
  Initialisation initialisation_;
  Map map_;
  Candidates candidates_;
  bool initialised_ = false;
  std::uint64_t version_ = 0;
  std::int64_t origin_frame_ = -1;
  std::vector<std::pair<std::int64_t, Pose>> early_poses_;  // keyframe0_T_camera
};

}  // namespace edgeslam
