#include "places/place_view.h"

#include <algorithm>
#include <opencv2/core/types.hpp>
#include <set>

#include "adjustment/reprojection.h"
#include "edges/point_spacing.h"
#include "geometry/camera_mask.h"

namespace edgeslam {
namespace {

constexpr double least_spacing = 3;  // [px]

PlacePoint placePoint(const Map& map, const MapPoint& point, const Pose& camera_T_world) {
  PlacePoint placed;
  placed.id = point.id;
  placed.position = camera_T_world * worldPosition(map, point);
  placed.depth_deviation = point.inverse_depth_sigma / point.inverse_depth;
  placed.corner = point.corner;
  return placed;
}

}  // namespace

std::vector<KeyframeId> covisibleWith(const Map& map, KeyframeId keyframe, int count) {
  const std::vector<int> shared = sharedPoints(map, keyframe);
  std::vector<KeyframeId> covisible;
  for (std::size_t k = 0; k < shared.size(); ++k) {
    if (shared[k] > 0) covisible.push_back(static_cast<KeyframeId>(k));
  }
  std::stable_sort(covisible.begin(), covisible.end(), [&](KeyframeId a, KeyframeId b) {
    return shared[static_cast<std::size_t>(a)] > shared[static_cast<std::size_t>(b)];
  });
  if (static_cast<int>(covisible.size()) > count) covisible.resize(static_cast<std::size_t>(std::max(0, count)));
  return covisible;
}

bool predictMeasurement(const Camera& camera, const Pose& camera_T_view, const Eigen::Vector3d& point,
                        const Measurement& measurement, Measurement& predicted) {
  constexpr double step = 2;  // along the edge [px]
  const Eigen::Vector3d seen = camera_T_view * point;
  if (!inFront(camera, seen)) return false;
  const Eigen::Vector2d tangent(-measurement.normal.y(), measurement.normal.x());
  const double distance = point.norm();
  const Eigen::Vector3d ahead = camera_T_view * (bearing(camera, measurement.pixel + step * tangent) * distance);
  const Eigen::Vector3d behind = camera_T_view * (bearing(camera, measurement.pixel - step * tangent) * distance);
  if (!inFront(camera, ahead) || !inFront(camera, behind)) return false;
  const Eigen::Vector2d direction = project(camera, ahead) - project(camera, behind);
  const double length = direction.norm();
  if (!(length > 1e-6)) return false;
  predicted = measurement;
  predicted.pixel = project(camera, seen);
  predicted.normal = Eigen::Vector2d(direction.y(), -direction.x()) / length;
  return true;
}

PlaceView placeView(const Camera& camera, const Map& map, KeyframeId keyframe, int neighbours) {
  PlaceView view;
  const Keyframe& centre = keyframeOf(map, keyframe);
  view.keyframe = keyframe;
  view.images = centre.images.get();
  const Pose camera_T_world = centre.world_T_camera.inverse();
  PointSpacing spacing(cv::Size(camera.width, camera.height), least_spacing);
  std::set<PointId> taken;
  for (const PointObservation& observation : centre.observations) {
    const auto found = map.points.find(observation.point);
    if (found == map.points.end()) continue;
    PlacePoint point = placePoint(map, found->second, camera_T_world);
    if (!inFront(camera, point.position)) continue;
    point.measurement = observation.measurement;
    point.observed = true;
    spacing.add(observation.measurement.pixel.cast<float>());
    taken.insert(observation.point);
    view.points.push_back(point);
  }
  for (const KeyframeId neighbour : covisibleWith(map, keyframe, neighbours)) {
    const Keyframe& other = keyframeOf(map, neighbour);
    const Pose other_T_world = other.world_T_camera.inverse();
    const Pose camera_T_other = camera_T_world * other.world_T_camera;
    for (const PointObservation& observation : other.observations) {
      const auto found = map.points.find(observation.point);
      if (found == map.points.end() || taken.count(observation.point) > 0) continue;
      PlacePoint point = placePoint(map, found->second, camera_T_world);
      const Eigen::Vector3d there = other_T_world * worldPosition(map, found->second);
      if (!predictMeasurement(camera, camera_T_other, there, observation.measurement, point.measurement)) continue;
      const Eigen::Vector2f pixel = point.measurement.pixel.cast<float>();
      if (!isLookedAt(camera, point.measurement.pixel, image_border) || !spacing.isFree(pixel)) continue;
      spacing.add(pixel);
      taken.insert(observation.point);
      view.points.push_back(point);
    }
  }
  return view;
}

}  // namespace edgeslam
