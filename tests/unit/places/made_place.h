// A map of known truth with images: a camera inside a box-shaped room whose walls carry random tiles, its keyframes
// rendered by ray casting, points chosen on their edges with exact depths, and drift put in afterwards.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "edges/point_choice.h"
#include "geometry/camera.h"
#include "geometry/similarity.h"
#include "map/map.h"

namespace edgeslam::test {

inline Camera placeCamera() {
  Camera camera;
  camera.width = 320;
  camera.height = 240;
  camera.fx = camera.fy = 210;
  camera.cx = 159.5;
  camera.cy = 119.5;
  return camera;
}

inline double hashed(std::uint64_t seed, int wall, int column, int row, int what) {
  std::uint64_t h = seed;
  for (const int value : {wall, column, row, what}) {
    h ^= static_cast<std::uint64_t>(value + 1000) + 0x9e3779b97f4a7c15u + (h << 6) + (h >> 2);
    h *= 0xbf58476d1ce4e5b9u;
    h ^= h >> 31;
  }
  return static_cast<double>(h >> 11) / 9007199254740992.0;
}

// Rooms from this number on have plain walls with a few large tiles.
constexpr std::uint64_t bare_rooms = 1000;

// Distance to the wall of the room, and the grey value there.
struct WallHit {
  double distance = 0;
  double grey = 0;
};

inline WallHit castRay(std::uint64_t seed, const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) {
  const Eigen::Vector3d half(2.5, 1.5, 3.0);
  WallHit hit;
  hit.distance = 1e9;
  int axis = 0;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(ray[i]) < 1e-12) continue;
    const double distance = (std::copysign(half[i], ray[i]) - origin[i]) / ray[i];
    if (distance < hit.distance) {
      hit.distance = distance;
      axis = i;
    }
  }
  const Eigen::Vector3d at = origin + hit.distance * ray;
  const int wall = 2 * axis + (ray[axis] > 0 ? 1 : 0);
  const bool bare = seed >= bare_rooms;
  const double tile = bare ? 0.75 : 0.3;
  const double u = at[(axis + 1) % 3] / tile, v = at[(axis + 2) % 3] / tile;
  const int column = static_cast<int>(std::floor(u)), row = static_cast<int>(std::floor(v));
  const double dx = u - column - 0.3 - 0.4 * hashed(seed, wall, column, row, 1);
  const double dy = v - row - 0.3 - 0.4 * hashed(seed, wall, column, row, 2);
  const double turn = 3.14 * hashed(seed, wall, column, row, 3);
  const double across = std::abs(std::cos(turn) * dx + std::sin(turn) * dy);
  const double along = std::abs(-std::sin(turn) * dx + std::cos(turn) * dy);
  const bool patch = across < 0.1 + 0.2 * hashed(seed, wall, column, row, 4) && along < 0.3;
  hit.grey = bare && !patch ? 90 + 20 * wall : 40 + 170 * hashed(seed, wall, column, row, patch ? 5 : 6);
  return hit;
}

inline cv::Mat renderRoom(std::uint64_t seed, const Camera& camera, const Pose& world_T_camera) {
  cv::Mat image(camera.height, camera.width, CV_8U);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      double sum = 0;
      for (const double sub_y : {-0.33, 0.0, 0.33}) {
        for (const double sub_x : {-0.33, 0.0, 0.33}) {
          const Eigen::Vector3d ray((x + sub_x - camera.cx) / camera.fx, (y + sub_y - camera.cy) / camera.fy, 1);
          sum += castRay(seed, world_T_camera.translation, world_T_camera.rotation * ray).grey;
        }
      }
      image.at<unsigned char>(y, x) = static_cast<unsigned char>(std::lround(sum / 9));
    }
  }
  return image;
}

// Keyframes at `poses` in the room `seed`. A point is followed from keyframe to keyframe until it leaves the image, and
// never found again.
inline Map makePlace(std::uint64_t seed, const Camera& camera, const std::vector<Pose>& poses) {
  Map map;
  PointId next = 0;
  std::vector<PointId> followed;
  PointChoiceOptions choice;
  choice.count = 260;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const auto id = static_cast<KeyframeId>(k);
    Keyframe keyframe;
    keyframe.id = id;
    keyframe.frame_index = 10 * static_cast<std::int64_t>(k);
    keyframe.time_ns = 400000000 * static_cast<std::int64_t>(k);
    keyframe.world_T_camera = poses[k];
    auto images = std::make_shared<FrameImages>();
    images->frame_index = keyframe.frame_index;
    images->time_ns = keyframe.time_ns;
    images->pyramid = buildPyramid(renderRoom(seed, camera, poses[k]), 4);
    keyframe.images = images;
    const cv::Mat& grey = images->pyramid.levels[0];

    std::vector<Eigen::Vector2f> occupied;
    std::vector<PointId> still_followed;
    for (const PointId point_id : followed) {
      MapPoint& point = map.points.at(point_id);
      const Pose& host = poses[static_cast<std::size_t>(point.host)];
      const Eigen::Vector3d seen = poses[k].inverse() * (host * (point.host_bearing / point.inverse_depth));
      if (seen.z() < 0.1) continue;
      const Eigen::Vector2d pixel = project(camera, seen);
      if (!insideImage(camera, pixel, 8)) continue;
      const StructureTensor tensor = structureTensor(grey, pixel.cast<float>(), choice.accuracy.tensor_window);
      PointObservation observation;
      observation.point = point_id;
      observation.bearing = bearing(camera, pixel);
      observation.corner = point.corner;
      observation.measurement.pixel = pixel;
      // From dark to bright, as an edge's normal is.
      const Eigen::Vector2d direction = tensor.direction.cast<double>();
      const Eigen::Vector3d ahead = observation.bearing + Eigen::Vector3d(direction.x(), direction.y(), 0) * 0.01;
      const Eigen::Vector3d behind = observation.bearing - Eigen::Vector3d(direction.x(), direction.y(), 0) * 0.01;
      const bool brighter_ahead = castRay(seed, poses[k].translation, poses[k].rotation * ahead).grey >=
                                  castRay(seed, poses[k].translation, poses[k].rotation * behind).grey;
      observation.measurement.normal = brighter_ahead ? direction : Eigen::Vector2d(-direction);
      observation.measurement.sigma_normal = point.corner ? 0.17 : 0.5;
      observation.measurement.sigma_tangent = point.corner ? 0.5 : 100;
      keyframe.observations.push_back(observation);
      occupied.push_back(pixel.cast<float>());
      point.seen_in.push_back(id);
      still_followed.push_back(point_id);
    }
    for (const ChosenPoint& chosen : choosePoints(grey, detectEdges(grey, {}), occupied, choice)) {
      PointObservation observation;
      observation.point = next++;
      observation.measurement = {chosen.pixel.cast<double>(), chosen.normal.cast<double>(), chosen.sigma_normal,
                                 chosen.sigma_tangent};
      observation.bearing = bearing(camera, observation.measurement.pixel);
      observation.corner = chosen.corner;
      keyframe.observations.push_back(observation);
      MapPoint point;
      point.id = observation.point;
      point.host = id;
      point.host_bearing = observation.bearing;
      point.inverse_depth = 1 / castRay(seed, poses[k].translation, poses[k].rotation * observation.bearing).distance;
      point.inverse_depth_sigma = 0.01 * point.inverse_depth;
      point.corner = chosen.corner;
      map.points.emplace(point.id, point);
      still_followed.push_back(point.id);
    }
    followed = std::move(still_followed);
    map.keyframes.push_back(std::move(keyframe));
  }
  // Points that only one keyframe saw are none.
  for (auto point = map.points.begin(); point != map.points.end();) {
    point = point->second.seen_in.empty() ? map.points.erase(point) : std::next(point);
  }
  return map;
}

constexpr int keyframes_a_turn = 24;  // of a whole turn in the tests of loops

// A turn by 360 degrees on a small circle, with `extra` keyframes beyond the first one; looks outwards.
inline std::vector<Pose> turnAround(int keyframes, int extra) {
  std::vector<Pose> poses;
  for (int k = 0; k < keyframes + extra; ++k) {
    const double angle = 2 * M_PI * k / keyframes;
    Pose pose;
    pose.rotation = rotationExp({0, angle, 0});
    pose.translation = 0.6 * Eigen::Vector3d(std::sin(angle), 0, std::cos(angle));
    if (k >= keyframes) pose.translation += Eigen::Vector3d(0.15, 0.1, -0.1);
    poses.push_back(pose);
  }
  return poses;
}

inline Similarity asSimilarity(const Pose& pose) { return {1, pose.rotation, pose.translation}; }

// Puts drift in: each step from keyframe to keyframe is made `step` too much in scale and turn.
inline void addDrift(double log_scale_a_step, double turn_a_step, Map& map) {
  std::vector<Similarity> drifted{asSimilarity(map.keyframes.front().world_T_camera)};
  for (std::size_t k = 1; k < map.keyframes.size(); ++k) {
    const Pose motion = map.keyframes[k - 1].world_T_camera.inverse() * map.keyframes[k].world_T_camera;
    const Similarity wrong{std::exp(log_scale_a_step), motion.rotation * rotationExp({0, turn_a_step, 0}),
                           motion.translation};
    drifted.push_back(drifted.back() * wrong);
  }
  for (std::size_t k = 0; k < drifted.size(); ++k) {
    map.keyframes[k].world_T_camera = {drifted[k].rotation, drifted[k].translation};
  }
  for (auto& [id, point] : map.points) {
    const double scale = drifted[static_cast<std::size_t>(point.host)].scale;
    point.inverse_depth /= scale;
    point.inverse_depth_sigma /= scale;
  }
}

// Root mean square distance of the keyframes from where they should be, after similarity alignment.
inline double positionError(const Map& map, const std::vector<Pose>& truth) {
  std::vector<Eigen::Vector3d> is, should_be;
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    is.push_back(map.keyframes[k].world_T_camera.translation);
    should_be.push_back(truth[k].translation);
  }
  const Similarity aligned = alignHorn(is, should_be);
  double squares = 0;
  for (std::size_t k = 0; k < is.size(); ++k) squares += (aligned * is[k] - should_be[k]).squaredNorm();
  return std::sqrt(squares / static_cast<double>(is.size()));
}

}  // namespace edgeslam::test
