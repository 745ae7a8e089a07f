#include "drivers/viewer/viewed_map.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "drivers/viewer/message_bytes.h"
#include "pipeline/map_records.h"

namespace edgeslam {
namespace {

constexpr std::uint32_t not_in_before = 0xffffffff;

std::uint8_t percent(float ratio) {
  return static_cast<std::uint8_t>(std::isfinite(ratio) ? std::clamp(100 * ratio, 0.0F, 255.0F) : 255.0F);
}

// Numbers in an order of their own that has nothing to do with theirs.
std::uint64_t shuffled(std::uint64_t id) {
  id = (id ^ (id >> 31)) * 0x9E3779B97F4A7C15U;
  return id ^ (id >> 32);
}

// Those that come first in the shuffled order: a map that grows a little loses a few of them only.
template <typename Record>
void thin(std::vector<Record>& records, std::size_t most) {
  if (records.size() <= most) return;
  std::vector<std::uint64_t> places;
  for (const Record& record : records) places.push_back(shuffled(static_cast<std::uint64_t>(record.id)));
  std::nth_element(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(most), places.end());
  const std::uint64_t bound = places[most];
  records.erase(std::remove_if(records.begin(), records.end(),
                               [&](const Record& r) { return shuffled(static_cast<std::uint64_t>(r.id)) >= bound; }),
                records.end());
}

template <typename Record>
void keepWorld(std::vector<Record>& records, int world) {
  records.erase(std::remove_if(records.begin(), records.end(), [=](const Record& r) { return r.world != world; }),
                records.end());
}

bool isSame(const ViewedPoint& a, const ViewedPoint& b) {
  return a.position == b.position && a.grey == b.grey && a.depth_sigma_percent == b.depth_sigma_percent &&
         a.joined == b.joined;
}

bool isSame(const ViewedKeyframe& a, const ViewedKeyframe& b) { return a.pose == b.pose; }

// A list in terms of the one before.
template <typename Item>
struct Changes {
  std::vector<std::uint32_t> runs;  // pairs: where a run begins in the list before, or not_in_before; its length
  std::vector<Item> added;          // of the runs that are not in the list before, one after the other
};

template <typename Item>
Changes<Item> changes(const std::vector<Item>& items, const std::vector<Item>* before) {
  std::unordered_map<std::int64_t, std::uint32_t> place_before;
  for (std::size_t i = 0; before && i < before->size(); ++i) {
    place_before.emplace((*before)[i].id, static_cast<std::uint32_t>(i));
  }
  Changes<Item> result;
  for (const Item& item : items) {
    const auto found = place_before.find(item.id);
    const bool is_same = found != place_before.end() && isSame((*before)[found->second], item);
    const std::uint32_t from = is_same ? found->second : not_in_before;
    if (!is_same) result.added.push_back(item);
    std::vector<std::uint32_t>& runs = result.runs;
    const bool goes_on = !runs.empty() && (is_same ? runs[runs.size() - 2] != not_in_before &&
                                                         runs[runs.size() - 2] + runs.back() == from
                                                   : runs[runs.size() - 2] == not_in_before);
    if (goes_on) {
      ++runs.back();
    } else {
      runs.insert(runs.end(), {from, 1});
    }
  }
  return result;
}

}  // namespace

ViewedMap viewedMap(const Map& map, int world, const Camera& camera, std::int64_t number) {
  ViewedMap viewed;
  viewed.number = number;
  viewed.world = world;
  std::vector<MapPointRecord> points = mapPointRecords(map, camera);
  keepWorld(points, world);
  viewed.points_in_map = points.size();
  points.erase(std::remove_if(points.begin(), points.end(),
                              [](const MapPointRecord& point) { return !point.position.cast<float>().allFinite(); }),
               points.end());
  thin(points, most_viewed_points);
  viewed.points.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const MapPointRecord& point = points[i];
    const Eigen::Vector3f position = point.position.cast<float>();
    const bool joined = i > 0 && point.chain == points[i - 1].chain;
    viewed.points.push_back({point.id,
                             {position.x(), position.y(), position.z()},
                             point.grey,
                             percent(point.depth_sigma_ratio),
                             static_cast<std::uint8_t>(joined)});
  }
  std::vector<KeyframeRecord> keyframes = keyframeRecords(map);
  keepWorld(keyframes, world);
  keyframes.erase(std::remove_if(keyframes.begin(), keyframes.end(),
                                 [](const KeyframeRecord& keyframe) { return !isFinite(keyframe.world_T_camera); }),
                  keyframes.end());
  viewed.keyframes_in_map = keyframes.size();
  thin(keyframes, most_viewed_keyframes);
  for (const KeyframeRecord& keyframe : keyframes) {
    const Eigen::Vector3f t = keyframe.world_T_camera.translation.cast<float>();
    const Eigen::Vector4f q = keyframe.world_T_camera.rotation.coeffs().cast<float>();
    viewed.keyframes.push_back({keyframe.id, {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}});
  }
  std::vector<MapLineRecord> lines = mapLineRecords(map);
  keepWorld(lines, world);
  thin(lines, most_viewed_lines);
  for (const MapLineRecord& line : lines) {
    const Eigen::Vector3f from = line.from.cast<float>(), to = line.to.cast<float>();
    if (from.allFinite() && to.allFinite())
      viewed.lines.push_back({from.x(), from.y(), from.z(), to.x(), to.y(), to.z()});
  }
  return viewed;
}

std::string mapMessage(const ViewedMap& map, const ViewedMap* before) {
  const Changes<ViewedPoint> points = changes(map.points, before ? &before->points : nullptr);
  const Changes<ViewedKeyframe> keyframes = changes(map.keyframes, before ? &before->keyframes : nullptr);
  std::string message = beginBinary(ViewMessage::map, {{"number", map.number},
                                                       {"world", map.world},
                                                       {"after", before ? before->number : 0},
                                                       {"points", map.points.size()},
                                                       {"points_in_map", map.points_in_map},
                                                       {"point_runs", points.runs.size() / 2},
                                                       {"new_points", points.added.size()},
                                                       {"keyframes", map.keyframes.size()},
                                                       {"keyframes_in_map", map.keyframes_in_map},
                                                       {"keyframe_runs", keyframes.runs.size() / 2},
                                                       {"new_keyframes", keyframes.added.size()},
                                                       {"lines", map.lines.size()}});
  for (const std::uint32_t number : points.runs) append(message, number);
  for (const std::uint32_t number : keyframes.runs) append(message, number);
  for (const ViewedPoint& point : points.added) {
    for (const float coordinate : point.position) appendFloat(message, coordinate);
  }
  for (const ViewedKeyframe& keyframe : keyframes.added) {
    for (const float number : keyframe.pose) appendFloat(message, number);
  }
  for (const ViewedLine& line : map.lines) {
    for (const float coordinate : line) appendFloat(message, coordinate);
  }
  for (const ViewedPoint& point : points.added) append(message, point.grey);
  for (const ViewedPoint& point : points.added) append(message, point.depth_sigma_percent);
  for (const ViewedPoint& point : points.added) append(message, point.joined);
  return message;
}

}  // namespace edgeslam
