// The map: keyframes and points of image edges. A point is its host keyframe, the bearing there and one unknown, the
// inverse distance along it (design, section 5). Mapping owns it; tracking sees a MapView.
#pragma once

#include <map>
#include <vector>

#include "geometry/found_camera.h"
#include "inertia/found_time_offset.h"
#include "inertia/found_unit_rotation.h"
#include "inertia/inertial_alignment.h"
#include "map/keyframe_table.h"
#include "wheels/wheel_scale.h"

namespace edgeslam {

struct MapPoint {
  PointId id = 0;
  KeyframeId host = 0;
  Eigen::Vector3d host_bearing;    // unit, host camera frame
  double inverse_depth = 0;        // 1 / distance along the bearing [1 / map unit]
  double inverse_depth_sigma = 0;  // standard deviation
  bool corner = false;
  KeyframeId chain_keyframe = 0;  // whose edges `chain` counts along: the first host
  int chain = -1;
  int order = 0;
  std::vector<KeyframeId> seen_in;  // keyframes other than the host, ascending
};

struct Map {
  KeyframeTable<Keyframe> keyframes;
  std::map<PointId, MapPoint> points;          // ordered, so that every sum over them is the same in every run
  std::map<LineId, MapLine> lines;             // likewise
  LineId next_line = 0;                        // no number is given twice
  std::map<int, InertialAlignment> inertia;    // by world, where there is an inertial unit
  std::map<int, WheelScale> wheels;            // by world, where there are wheels
  FoundCamera found;                           // what all rays here were taken with
  std::optional<FoundTimeOffset> time_offset;  // that links were measured with, where it is not the one that was given
  std::optional<FoundUnitRotation> unit_rotation;  // of the inertial unit, where it is not the one that was given
  bool unit_is_left_out = false;  // it contradicts the camera: what it felt between keyframes does not count
};

// A keyframe to read, of a map that may be changed too.
inline const Keyframe& keyframeOf(const Map& map, KeyframeId id) { return map.keyframes[id]; }

// Position in the world frame.
inline Eigen::Vector3d worldPosition(const Map& map, const MapPoint& point) {
  return map.keyframes[point.host].world_T_camera * (point.host_bearing / point.inverse_depth);
}

// A line in the world frame, and set from there.
SpaceLine inWorld(const Map& map, const MapLine& line);
void setInWorld(const SpaceLine& in_world, const Map& map, MapLine& line);

// Makes all lengths in a line's host frame `factor` times as long.
void scaleLine(double factor, MapLine& line);

// Takes a line out of the map, and what keyframes know of it; its points stay.
void dissolveLine(LineId line, Map& map);

// Gives a point its place on a ray of its host's camera frame, from where the ray begins: the depth is kept from the
// camera's centre.
void setPlace(const Eigen::Vector3d& ray_origin, const Eigen::Vector3d& direction, double inverse_depth, double sigma,
              MapPoint& point);

// The observation of a point in a keyframe, or null.
const PointObservation* findObservation(const Keyframe& keyframe, PointId point);

// One over the latest keyframe's number: the size of what is kept by keyframe number.
inline std::size_t numberOfKeyframes(const Map& map) {
  return map.keyframes.empty() ? 0 : static_cast<std::size_t>(map.keyframes.back().id) + 1;
}

// One over the largest number of a track that any keyframe saw.
PointId firstFreePoint(const Map& map);

// Median distance of the map points that a keyframe sees from it [map units]; 0 where they are fewer than `fewest`.
double sceneDistance(const Map& map, const Keyframe& keyframe, std::size_t fewest = 1);

// P18: number of map points that each keyframe shares with `keyframe`, by keyframe number (0 for itself).
std::vector<int> sharedPoints(const Map& map, KeyframeId keyframe);

}  // namespace edgeslam
