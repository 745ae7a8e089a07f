#include "drivers/lcm/map_messages.h"

#include <algorithm>

#include "drivers/lcm/messages.h"

namespace edgeslam {

std::vector<PublishedPoint> finitePoints(std::vector<PublishedPoint> points) {
  const auto broken = [](const PublishedPoint& point) {
    return !point.position.allFinite() || !point.direction.allFinite();
  };
  points.erase(std::remove_if(points.begin(), points.end(), broken), points.end());
  return points;
}

int numberOfMapParts(std::size_t points) {
  constexpr std::size_t in_a_part = map_part_t::MOST_POINTS;
  return std::max(1, static_cast<int>((points + in_a_part - 1) / in_a_part));
}

map_part_t mapPart(const std::vector<PublishedPoint>& points, int part, std::int64_t version, std::int64_t utime,
                   const ScaleState& scale) {
  map_part_t message{};
  message.utime = utime;
  message.version = version;
  message.part = part;
  message.parts = numberOfMapParts(points.size());
  message.points_in_map = static_cast<std::int32_t>(points.size());
  message.scale_state = scaleNumber(scale.kind);
  const std::size_t first = static_cast<std::size_t>(part) * map_part_t::MOST_POINTS;
  const std::size_t last = std::min(points.size(), first + map_part_t::MOST_POINTS);
  for (std::size_t i = first; i < last; ++i) {
    const std::size_t at = i - first;
    const Eigen::Vector3f position = static_cast<float>(scale.metres_per_unit) * points[i].position;
    message.id[at] = points[i].id;
    std::copy_n(position.data(), 3, message.position[at]);
    std::copy_n(points[i].direction.data(), 3, message.direction[at]);
  }
  message.points = static_cast<std::int32_t>(last > first ? last - first : 0);
  return message;
}

}  // namespace edgeslam
