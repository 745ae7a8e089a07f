#include "tracking/seen_points.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace edgeslam {
namespace {

constexpr double most_steps = std::numeric_limits<std::uint16_t>::max();

std::uint16_t inSteps(double value) {
  return static_cast<std::uint16_t>(std::lround(std::clamp(value, 0.0, most_steps)));
}

}  // namespace

void pack(const Camera& camera, const std::vector<Track>& tracks, std::size_t most, SeenPoints& seen) {
  seen.points.clear();
  if (tracks.empty()) return;
  seen.first = tracks.front().id;
  seen.pixel_step = std::max(camera.width, camera.height) / most_steps;
  for (const Track& track : tracks) {
    const PointId after_first = track.id - seen.first;
    if (seen.points.size() == most || after_first > std::numeric_limits<std::uint32_t>::max()) break;
    PackedPoint& packed = seen.points.emplace_back();
    packed.after_first = static_cast<std::uint32_t>(after_first);
    packed.x = inSteps(track.pixel.x() / seen.pixel_step);
    packed.y = inSteps(track.pixel.y() / seen.pixel_step);
    packed.normal_x = Eigen::half(track.normal.x());
    packed.normal_y = Eigen::half(track.normal.y());
    packed.sigma_normal = Eigen::half(track.sigma_normal);
    packed.sigma_tangent = Eigen::half(sigmaAlong(track));
  }
}

SeenPoint seenPoint(const SeenPoints& seen, std::size_t index) {
  const PackedPoint& packed = seen.points[index];
  const Eigen::Vector2d normal(static_cast<double>(packed.normal_x), static_cast<double>(packed.normal_y));
  return {seen.first + packed.after_first,
          {seen.pixel_step * Eigen::Vector2d(packed.x, packed.y), normal.normalized(),
           static_cast<double>(packed.sigma_normal), static_cast<double>(packed.sigma_tangent)}};
}

}  // namespace edgeslam
