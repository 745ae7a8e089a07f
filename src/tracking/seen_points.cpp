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

void SeenPoints::assign(const Camera& camera, const std::vector<Track>& tracks, std::size_t most) {
  points_.clear();
  if (tracks.empty()) return;
  first_ = tracks.front().id;
  pixel_step_ = std::max(camera.width, camera.height) / most_steps;
  for (const Track& track : tracks) {
    const PointId after_first = track.id - first_;  // ids ascend
    if (points_.size() == most || after_first > std::numeric_limits<std::uint32_t>::max()) break;
    Packed& packed = points_.emplace_back();
    packed.after_first = static_cast<std::uint32_t>(after_first);
    packed.x = inSteps(track.pixel.x() / pixel_step_);
    packed.y = inSteps(track.pixel.y() / pixel_step_);
    packed.normal_x = Eigen::half(track.normal.x());
    packed.normal_y = Eigen::half(track.normal.y());
    packed.sigma_normal = Eigen::half(track.sigma_normal);
    packed.sigma_tangent = Eigen::half(track.sigma_tangent);
  }
}

SeenPoints::Seen SeenPoints::operator[](std::size_t i) const {
  const Packed& packed = points_[i];
  const Eigen::Vector2d normal(static_cast<double>(packed.normal_x), static_cast<double>(packed.normal_y));
  return {first_ + packed.after_first,
          {pixel_step_ * Eigen::Vector2d(packed.x, packed.y), normal.normalized(),
           static_cast<double>(packed.sigma_normal), static_cast<double>(packed.sigma_tangent)}};
}

}  // namespace edgeslam
