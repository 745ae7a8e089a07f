#include "drivers/lcm/map_messages.h"

#include <algorithm>

#include "drivers/lcm/messages.h"

namespace edgeslam {
namespace {

template <class Item, class IsBroken>
void leaveOut(std::vector<Item>& items, const IsBroken& is_broken) {
  items.erase(std::remove_if(items.begin(), items.end(), is_broken), items.end());
}

int numberOfParts(std::size_t items, std::size_t in_a_part) {
  return std::max(1, static_cast<int>((items + in_a_part - 1) / in_a_part));
}

// From `first` on, before `last`.
struct ItemRange {
  std::size_t first = 0, last = 0;
};

ItemRange itemsOfPart(int part, std::size_t items, std::size_t in_a_part) {
  const std::size_t first = std::min(items, static_cast<std::size_t>(part) * in_a_part);
  return {first, std::min(items, first + in_a_part)};
}

// With the fields that parts of points and of lines share.
template <class Message>
Message emptyPart(int part, int parts, std::int64_t version, std::int64_t utime, const RobotSetup& robot) {
  Message message{};
  message.utime = utime;
  message.version = version;
  message.part = part;
  message.parts = parts;
  message.scale_state = scaleNumber(robot.scale.kind);
  return message;
}

void writePlace(const Eigen::Vector3f& point, const RobotSetup& robot, float (&to)[3]) {
  const Eigen::Vector3f place = pointInWorld(point, robot);
  std::copy_n(place.data(), 3, to);
}

}  // namespace

PublishedMap finiteMap(PublishedMap map) {
  leaveOut(map.points,
           [](const PublishedPoint& point) { return !point.position.allFinite() || !point.direction.allFinite(); });
  leaveOut(map.lines, [](const PublishedLine& line) { return !line.from.allFinite() || !line.to.allFinite(); });
  return map;
}

int numberOfPointParts(std::size_t points) { return numberOfParts(points, map_part_t::MOST_POINTS); }

int numberOfLineParts(std::size_t lines) { return numberOfParts(lines, map_lines_t::MOST_LINES); }

map_part_t pointPart(const std::vector<PublishedPoint>& points, int part, std::int64_t version, std::int64_t utime,
                     const RobotSetup& robot) {
  auto message = emptyPart<map_part_t>(part, numberOfPointParts(points.size()), version, utime, robot);
  const auto [first, last] = itemsOfPart(part, points.size(), map_part_t::MOST_POINTS);
  message.points_in_map = static_cast<std::int32_t>(points.size());
  message.points = static_cast<std::int32_t>(last - first);
  const Eigen::Quaternionf turn = worldTurnedUp(robot).cast<float>();
  for (std::size_t i = first; i < last; ++i) {
    const std::size_t at = i - first;
    message.id[at] = points[i].id;
    writePlace(points[i].position, robot, message.position[at]);
    const Eigen::Vector3f direction = turn * points[i].direction;
    std::copy_n(direction.data(), 3, message.direction[at]);
  }
  return message;
}

map_lines_t linePart(const std::vector<PublishedLine>& lines, int part, std::int64_t version, std::int64_t utime,
                     const RobotSetup& robot) {
  auto message = emptyPart<map_lines_t>(part, numberOfLineParts(lines.size()), version, utime, robot);
  const auto [first, last] = itemsOfPart(part, lines.size(), map_lines_t::MOST_LINES);
  message.lines_in_map = static_cast<std::int32_t>(lines.size());
  message.lines = static_cast<std::int32_t>(last - first);
  for (std::size_t i = first; i < last; ++i) {
    const std::size_t at = i - first;
    message.id[at] = lines[i].id;
    writePlace(lines[i].from, robot, message.first_end[at]);
    writePlace(lines[i].to, robot, message.second_end[at]);
  }
  return message;
}

}  // namespace edgeslam
