#include "mapping/motion_along_lines.h"

#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "map/worlds.h"
#include "mapping/line_views.h"

namespace edgeslam {
namespace {

// All tracks of a line err together as they slide: so much each if they were one [px].
constexpr double sigma_along = 3;
constexpr double unknown_across = 1000;        // [px]; what is known across the line, its views say
constexpr double relative_depth_sigma = 0.01;  // holds a point on its line, and lets the map's unit change

struct Slide {
  const PointObservation* before;
  const PointObservation* now;
};

// Tracks that both keyframes see on the same line, by line.
std::map<LineId, std::vector<Slide>> slidesBetween(const Keyframe& before, const Keyframe& now) {
  std::map<LineId, std::vector<Slide>> slides;
  for (const PointObservation& seen : now.observations) {
    const LineId line = lineOf(now, seen);
    if (line < 0 || seen.corner) continue;
    const PointObservation* was = findObservation(before, seen.point);
    if (was && lineOf(before, *was) == line) slides[line].push_back({was, &seen});
  }
  return slides;
}

// Where the ray of a keyframe's row, on which it sees a track, meets a line.
std::optional<BundlePoint> pointOnLine(const Camera& camera, const SpaceLine& line, const Keyframe& host,
                                       const PointObservation& seen, int host_index) {
  const Eigen::Vector3d row_centre = rowPose(camera, host.twist, seen.measurement.pixel.y()).translation;
  const Eigen::Vector3d origin = host.world_T_camera * row_centre;
  const Eigen::Vector3d ray = host.world_T_camera.rotation * seen.bearing;
  const double distance = distanceAlongRay(line, origin, ray);
  if (!(distance > 0) || !std::isfinite(distance)) return std::nullopt;
  const Eigen::Vector3d in_host = host.world_T_camera.inverse() * closestPoint(line, origin + distance * ray);
  BundlePoint point;
  point.host = host_index;
  point.host_bearing = in_host.normalized();
  point.inverse_depth = point.prior_inverse_depth = 1 / in_host.norm();
  point.prior_sigma = relative_depth_sigma * point.inverse_depth;
  return point;
}

}  // namespace

void addMotionAlongLines(const Camera& camera, const Map& map, const std::vector<LineId>& lines,
                         const std::function<int(KeyframeId)>& camera_of, BundleProblem& problem) {
  std::map<LineId, SpaceLine> in_world;
  for (const LineId id : lines) in_world[id] = inWorld(map, map.lines.at(id));
  if (in_world.empty()) return;
  const auto isFixed = [&](int index) { return problem.cameras[static_cast<std::size_t>(index)].fixed; };
  for (const Keyframe& now : map.keyframes) {
    const KeyframeId last = keyframeBefore(map, now.id);
    if (last < 0) continue;
    const int camera_before = camera_of(last), camera_now = camera_of(now.id);
    if (camera_before < 0 || camera_now < 0 || (isFixed(camera_before) && isFixed(camera_now))) continue;
    const Keyframe& before = map.keyframes[last];
    for (const auto& [line, slides] : slidesBetween(before, now)) {
      const auto found = in_world.find(line);
      if (found == in_world.end()) continue;
      const double sigma = sigma_along * std::sqrt(static_cast<double>(slides.size()));
      for (const Slide& slide : slides) {
        const auto point = pointOnLine(camera, found->second, before, *slide.before, camera_before);
        if (!point) continue;
        Measurement measurement = slide.now->measurement;
        measurement.sigma_normal = unknown_across;
        measurement.sigma_tangent = sigma;
        problem.observations.push_back({camera_now, static_cast<int>(problem.points.size()), measurement});
        problem.points.push_back(*point);
      }
    }
  }
}

}  // namespace edgeslam
