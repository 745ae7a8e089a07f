#include "pipeline/map_records.h"

#include <algorithm>

namespace edgeslam {
namespace {

struct ChainKey {
  KeyframeId keyframe;
  int chain;
  bool operator<(const ChainKey& other) const {
    return keyframe != other.keyframe ? keyframe < other.keyframe : chain < other.chain;
  }
};

// Direction of the edge in space from its neighbours along the chain: the chord between them.
void writeDirections(std::vector<MapPointRecord>& records) {
  for (std::size_t i = 0; i < records.size(); ++i) {
    const bool has_previous = i > 0 && records[i - 1].chain == records[i].chain;
    const bool has_next = i + 1 < records.size() && records[i + 1].chain == records[i].chain;
    const Eigen::Vector3d chord = records[has_next ? i + 1 : i].position - records[has_previous ? i - 1 : i].position;
    const double length = chord.norm();
    records[i].edge_direction = length > 0 ? Eigen::Vector3d(chord / length) : Eigen::Vector3d::Zero();
  }
}

// A point's place among the records, and in its host's image.
struct HostedRecord {
  std::size_t record = 0;
  Eigen::Vector2d pixel;
};

// Host by host: images that are packed are unpacked once, and one at a time.
void writeGreys(const Camera& camera, const Keyframe& host, const std::vector<HostedRecord>& points,
                std::vector<MapPointRecord>& records) {
  if (!host.images) return;
  {
    const std::shared_ptr<const FrameImages> images = host.images.get();
    const cv::Mat& grey = images->pyramid.levels[0];
    for (const HostedRecord& point : points) {
      if (!insideImage(camera, point.pixel, 1)) continue;
      records[point.record].grey =
          grey.at<unsigned char>(static_cast<int>(point.pixel.y() + 0.5), static_cast<int>(point.pixel.x() + 0.5));
    }
  }
  host.images.pack();
}

}  // namespace

std::vector<KeyframeRecord> keyframeRecords(const Map& map, KeyframeId first) {
  std::vector<KeyframeRecord> records;
  for (const Keyframe& keyframe : map.keyframes) {
    if (keyframe.id < first) continue;
    KeyframeRecord record;
    record.id = keyframe.id;
    record.world = keyframe.world;
    record.frame_index = keyframe.frame_index;
    record.time_ns = keyframe.time_ns;
    record.world_T_camera = keyframe.world_T_camera;
    record.reason = keyframe.reason;
    for (const PointObservation& observation : keyframe.observations)
      record.shared_points += map.points.count(observation.point) > 0;
    records.push_back(record);
  }
  return records;
}

std::vector<MapPointRecord> mapPointRecords(const Map& map, const Camera& camera) {
  std::map<ChainKey, std::vector<const MapPoint*>> chains;
  for (const auto& [id, point] : map.points) chains[{point.chain_keyframe, point.chain}].push_back(&point);
  std::vector<MapPointRecord> records;
  std::map<KeyframeId, std::vector<HostedRecord>> hosted;
  int chain_number = 0;
  for (auto& [key, points] : chains) {
    std::stable_sort(points.begin(), points.end(),
                     [](const MapPoint* a, const MapPoint* b) { return a->order < b->order; });
    for (const MapPoint* point : points) {
      MapPointRecord record;
      record.id = point->id;
      record.world = map.keyframes[point->host].world;
      record.position = worldPosition(map, *point);
      record.chain = chain_number;
      record.order = point->order;
      record.depth_sigma_ratio = static_cast<float>(point->inverse_depth_sigma / point->inverse_depth);
      hosted[point->host].push_back({records.size(), project(camera, point->host_bearing)});
      records.push_back(record);
    }
    ++chain_number;
  }
  for (const auto& [host, points] : hosted) writeGreys(camera, map.keyframes[host], points, records);
  writeDirections(records);
  return records;
}

std::vector<MapLineRecord> mapLineRecords(const Map& map) {
  std::vector<MapLineRecord> records;
  for (const auto& [id, line] : map.lines) {
    if (!line.is_placed) continue;
    const SpaceLine in_world = inWorld(map, line);
    MapLineRecord record;
    record.from = in_world.point + line.begin * in_world.direction;
    record.to = in_world.point + line.end * in_world.direction;
    record.keyframes = static_cast<int>(line.seen_in.size());
    record.id = id;
    record.world = map.keyframes[line.host].world;
    records.push_back(record);
  }
  return records;
}

}  // namespace edgeslam
