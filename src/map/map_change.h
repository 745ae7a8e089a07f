// What a correction of the map as a whole did to a copy of it, as a value that can be applied to the map that has grown
// since: a closed loop, a global adjustment (P20, P27).
#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/similarity.h"
#include "map/map.h"
#include "map/worlds.h"

namespace edgeslam {

struct MapChange {
  struct PointDepth {
    KeyframeId host = -1;
    double inverse_depth = 0, inverse_depth_sigma = 0;
    double scale = 1;  // how much longer its distance became: for a point that has another host by now
  };
  struct LinePlace {
    KeyframeId host = -1;
    SpaceLine in_host;
    double begin = 0, end = 0;
    double scale = 1;  // how much longer lengths around it became: for a line that has another host by now
  };
  struct View {
    KeyframeId keyframe = -1;
    PointObservation observation;
  };
  std::map<KeyframeId, Pose> world_T_camera;  // of every keyframe of the copy
  std::map<KeyframeId, Twist> twists;         // likewise
  std::map<PointId, PointDepth> depths;       // of every point that is left
  std::map<LineId, LinePlace> lines;          // of every placed line that is left
  std::vector<LineId> dissolved_lines;
  std::vector<PointId> erased_points;
  std::vector<std::pair<PointId, KeyframeId>> erased_views;  // no longer in `seen_in`
  std::vector<View> added_views;                             // by point, then keyframe
  int newer_world = 0;                                       // the copy's latest keyframe was in ...
  Similarity newer_S_world;                                  // ... and moves what is newer in that world as it moved
  std::optional<WorldJoin> join;

  bool empty() const { return world_T_camera.empty(); }
};

// From a copy of the map before the correction to the same copy after it, in which the worlds of `join` are one.
// Keyframes are neither made nor taken out.
MapChange changeOf(const Map& before, const Map& after, const std::optional<WorldJoin>& join = std::nullopt);

// Keyframes and points that are no longer there are passed over; what came since moves along with the latest keyframe
// of the copy.
void applyChange(const MapChange& change, Map& map);

}  // namespace edgeslam
