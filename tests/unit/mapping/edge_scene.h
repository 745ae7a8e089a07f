// A scene of straight edges whose places in space are known, what tracking sees of it from any pose, and maps of it.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "map/map.h"
#include "unit/adjustment/synthetic_scene.h"

namespace edgeslam::test {

struct EdgeScene {
  struct Point {
    Eigen::Vector3d position;   // world
    Eigen::Vector3d direction;  // of its edge, unit
    int chain = 0;
    int order = 0;
    bool corner = false;
  };
  std::vector<Point> points;  // the index is the point's id
};

// Frames of pictures, standing out of a wall and leaning against it by up to `depth` of its distance: four edges each,
// that meet in corners.
inline EdgeScene framesOnAWall(std::uint64_t seed, double distance = 3, double depth = 0.35) {
  Random random(seed);
  EdgeScene scene;
  int chain = 0;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 5; ++column) {
      const Eigen::Vector3d centre((column - 2) * 0.22 * distance, (row - 1.5) * 0.2 * distance,
                                   distance * (1 + uniform(random, -depth, depth)));
      const double turn = uniform(random, 0, M_PI), size = 0.08 * distance;
      const Eigen::Vector3d right(size * std::cos(turn), size * std::sin(turn), size * uniform(random, -0.7, 0.7));
      const Eigen::Vector3d down(-size * std::sin(turn), size * std::cos(turn), size * uniform(random, -0.7, 0.7));
      const Eigen::Vector3d corners[] = {centre - right - down, centre + right - down, centre + right + down,
                                         centre - right + down};
      for (int side = 0; side < 4; ++side) {
        const Eigen::Vector3d from = corners[side], to = corners[(side + 1) % 4];
        for (int k = 0; k < 5; ++k) {
          const bool corner = k == 0;
          scene.points.push_back({from + (to - from) * k / 5.0, (to - from).normalized(), chain, k, corner});
        }
        ++chain;
      }
    }
  }
  return scene;
}

struct Sight {
  double noise = 0;           // of each measurement, in its standard deviations
  double slide_px = 0;        // most that a point of an edge slid along it
  double sigma_edge = 0.5;    // [px]
  double sigma_corner = 0.2;  // [px]
  double least_depth = 0.1;
};

inline PointObservation observe(const Camera& camera, const EdgeScene& scene, std::size_t i, const Pose& world_T_camera,
                                const Sight& sight, Random& random) {
  const EdgeScene::Point& point = scene.points[i];
  const Pose camera_T_world = world_T_camera.inverse();
  const Eigen::Vector2d pixel = project(camera, camera_T_world * point.position);
  const Eigen::Vector2d next = project(camera, camera_T_world * (point.position + 0.01 * point.direction));
  const Eigen::Vector2d tangent = (next - pixel).normalized();
  PointObservation observation;
  observation.point = static_cast<PointId>(i);
  observation.corner = point.corner;
  observation.chain = point.chain;
  observation.order = point.order;
  Measurement& m = observation.measurement;
  m.normal = {-tangent.y(), tangent.x()};
  m.sigma_normal = point.corner ? sight.sigma_corner : sight.sigma_edge;
  m.sigma_tangent = point.corner ? sight.sigma_corner : 1000;
  m.pixel = pixel + gaussian(random, sight.noise * m.sigma_normal) * m.normal +
            (point.corner ? gaussian(random, sight.noise * m.sigma_tangent)
                          : uniform(random, -sight.slide_px, sight.slide_px)) *
                tangent;
  observation.bearing = bearing(camera, m.pixel);
  return observation;
}

// All points that are in the image, by id.
inline std::vector<PointObservation> observeAll(const Camera& camera, const EdgeScene& scene,
                                                const Pose& world_T_camera, const Sight& sight, Random& random) {
  std::vector<PointObservation> observations;
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    const Eigen::Vector3d in_camera = world_T_camera.inverse() * scene.points[i].position;
    if (in_camera.z() < sight.least_depth || !insideImage(camera, project(camera, in_camera), 10)) continue;
    observations.push_back(observe(camera, scene, i, world_T_camera, sight, random));
  }
  return observations;
}

// Keyframes at these poses without any point yet.
inline Map keyframesOf(const Camera& camera, const EdgeScene& scene, const std::vector<Pose>& poses, const Sight& sight,
                       Random& random) {
  Map map;
  for (const Pose& pose : poses) {
    Keyframe keyframe;
    keyframe.id = static_cast<KeyframeId>(map.keyframes.size());
    keyframe.frame_index = 10 * keyframe.id;
    keyframe.world_T_camera = pose;
    keyframe.observations = observeAll(camera, scene, pose, sight, random);
    map.keyframes.push_back(std::move(keyframe));
  }
  return map;
}

// Every point that two keyframes see becomes a map point, at its true depth along the bearing measured in its host.
inline void addAllPoints(const EdgeScene& scene, Map& map) {
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    const auto id = static_cast<PointId>(i);
    MapPoint point;
    point.id = id;
    bool hosted = false;
    for (const Keyframe& keyframe : map.keyframes) {
      const PointObservation* seen = findObservation(keyframe, id);
      if (!seen) continue;
      if (hosted) {
        point.seen_in.push_back(keyframe.id);
        continue;
      }
      hosted = true;
      point.host = keyframe.id;
      point.host_bearing = seen->bearing;
      point.inverse_depth = 1 / (keyframe.world_T_camera.inverse() * scene.points[i].position).norm();
      point.inverse_depth_sigma = 0.02 * point.inverse_depth;
      point.corner = seen->corner;
      point.chain = seen->chain;
      point.order = seen->order;
    }
    if (!point.seen_in.empty()) map.points.emplace(id, point);
  }
}

}  // namespace edgeslam::test
