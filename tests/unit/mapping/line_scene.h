// Straight edges of space, and what keyframes see of them: both ends of each, and tracks between.
#pragma once

#include <vector>

#include "map/map.h"
#include "unit/adjustment/synthetic_scene.h"

namespace edgeslam::test {

// From one end to the other the brighter side is on the left as seen from cameras near the origin that look along +z.
struct SpaceEdge {
  Eigen::Vector3d from, to;  // world
};

inline SpaceLine lineThrough(const SpaceEdge& edge) {
  return {0.5 * (edge.from + edge.to), (edge.to - edge.from).normalized()};
}

constexpr int tracks_on_edge = 6;

// Of a track on an edge.
inline PointId trackOf(std::size_t edge, int place) { return 100 * static_cast<PointId>(edge) + place; }

struct EdgeSight {
  double sigma = 0.1;  // of an edge's ends, across it [px]
  double noise = 0;    // of them, in their standard deviations
  double slide = 0;    // of all tracks, along their edges [px]
};

inline EdgeEnd endAt(const Camera& camera, const Eigen::Vector2d& pixel) { return {pixel, bearing(camera, pixel)}; }

// A keyframe that sees the edges whose ends are both in the image.
inline Keyframe keyframeThatSees(const Camera& camera, const std::vector<SpaceEdge>& edges, KeyframeId id,
                                 const Pose& world_T_camera, const EdgeSight& sight, Random& random) {
  Keyframe keyframe;
  keyframe.id = id;
  keyframe.world_T_camera = world_T_camera;
  const Pose camera_T_world = world_T_camera.inverse();
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Eigen::Vector3d from = camera_T_world * edges[i].from, to = camera_T_world * edges[i].to;
    if (!(from.z() > 0.1 && to.z() > 0.1)) continue;
    Eigen::Vector2d ends[2] = {project(camera, from), project(camera, to)};
    if (!insideImage(camera, ends[0], 5) || !insideImage(camera, ends[1], 5)) continue;
    const Eigen::Vector2d along = (ends[1] - ends[0]).normalized(), across(-along.y(), along.x());
    for (int k = 0; k < tracks_on_edge; ++k) {
      const double share = (k + 1.0) / (tracks_on_edge + 1);
      PointObservation seen;
      seen.point = trackOf(i, k);
      seen.measurement.pixel = project(camera, from + share * (to - from)) + sight.slide * along;
      seen.measurement.normal = across;
      seen.measurement.sigma_normal = 0.3;
      seen.measurement.sigma_tangent = 1000;
      seen.bearing = bearing(camera, seen.measurement.pixel);
      seen.straight_edge = static_cast<int>(keyframe.straight_edges.size());
      keyframe.observations.push_back(seen);
    }
    for (Eigen::Vector2d& end : ends) end += gaussian(random, sight.noise * sight.sigma) * across;
    keyframe.straight_edges.push_back(
        {-1, endAt(camera, ends[0]), endAt(camera, ends[1]), sight.sigma / meanFocalLength(camera)});
  }
  return keyframe;
}

// A line of the map for each edge, with all views of it, where it is.
inline void addPlacedLines(const std::vector<SpaceEdge>& edges, Map& map) {
  for (std::size_t i = 0; i < edges.size(); ++i) {
    MapLine line;
    line.id = map.next_line++;
    for (Keyframe& keyframe : map.keyframes) {
      for (const PointObservation& seen : keyframe.observations) {
        if (seen.point != trackOf(i, 0)) continue;
        keyframe.straight_edges[static_cast<std::size_t>(seen.straight_edge)].line = line.id;
        line.seen_in.push_back(keyframe.id);
      }
    }
    if (line.seen_in.empty()) continue;
    line.host = line.seen_in.front();
    line.is_placed = true;
    setInWorld(lineThrough(edges[i]), map, line);
    const double half = 0.5 * (edges[i].to - edges[i].from).norm();
    line.begin = -half;
    line.end = half;
    map.lines.emplace(line.id, line);
  }
}

inline Pose poseAt(double x, double y, double z, const Eigen::Vector3d& turned = Eigen::Vector3d::Zero()) {
  return {rotationExp(turned), {x, y, z}};
}

// Borders of panels that stand zig-zag, with a floor and a ceiling.
inline std::vector<SpaceEdge> zigzag() {
  std::vector<SpaceEdge> edges;
  for (int i = 0; i < 5; ++i) {
    const double x = -1.2 + 0.6 * i, depth = 3 + 0.5 * (i % 2), next_depth = 3.5 - 0.5 * (i % 2);
    edges.push_back({{x, -0.7, depth}, {x, 0.7, depth}});
    if (i == 4) break;
    edges.push_back({{x + 0.1, 0.8, depth}, {x + 0.5, 0.8, next_depth}});
    edges.push_back({{x + 0.5, -0.8, next_depth}, {x + 0.1, -0.8, depth}});
  }
  return edges;
}

inline const std::vector<SpaceEdge> zigzag_edges = zigzag();

// Of keyframes that go sideways along the panels, with their lines placed, and every track a point on its line.
inline Map mapOfPanels(const EdgeSight& sight, Random& random, int keyframes = 5) {
  Map map;
  for (KeyframeId id = 0; id < keyframes; ++id) {
    const Pose pose = poseAt(0.08 * id, 0.02 * (id % 3), 0.03 * (id % 2), {0.01 * id, -0.02 * id, 0});
    map.keyframes.push_back(keyframeThatSees(distorted_camera, zigzag_edges, id, pose, sight, random));
  }
  addPlacedLines(zigzag_edges, map);
  for (std::size_t i = 0; i < zigzag_edges.size(); ++i) {
    for (int k = 0; k < tracks_on_edge; ++k) {
      MapPoint point;
      point.id = trackOf(i, k);
      bool hosted = false;
      for (const Keyframe& keyframe : map.keyframes) {
        const PointObservation* seen = findObservation(keyframe, point.id);
        if (!seen) continue;
        if (hosted) {
          point.seen_in.push_back(keyframe.id);
          continue;
        }
        hosted = true;
        const double share = (k + 1.0) / (tracks_on_edge + 1);
        const Eigen::Vector3d position = zigzag_edges[i].from + share * (zigzag_edges[i].to - zigzag_edges[i].from);
        point.host = keyframe.id;
        point.host_bearing = seen->bearing;
        point.inverse_depth = 1 / (keyframe.world_T_camera.inverse() * position).norm();
        point.inverse_depth_sigma = 0.1 * point.inverse_depth;
      }
      if (!point.seen_in.empty()) map.points.emplace(point.id, point);
    }
  }
  return map;
}

// As if every second keyframe had seen the line elsewhere.
inline void contradictViewsOf(LineId line, Map& map) {
  for (Keyframe& keyframe : map.keyframes) {
    for (SeenEdge& edge : keyframe.straight_edges) {
      if (edge.line != line) continue;
      const double off = keyframe.id % 2 == 0 ? 3 : -3;
      edge.from = endAt(distorted_camera, edge.from.pixel + Eigen::Vector2d(off, off));
      edge.to = endAt(distorted_camera, edge.to.pixel + Eigen::Vector2d(off, off));
    }
  }
}

}  // namespace edgeslam::test
