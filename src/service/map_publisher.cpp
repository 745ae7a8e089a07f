#include "service/map_publisher.h"

#include <algorithm>
#include <cassert>
#include <map>
#include <utility>
#include <vector>

#include "map/worlds.h"
#include "pipeline/map_records.h"

namespace edgeslam {
namespace {

constexpr auto shown_interval = std::chrono::seconds(2);

}  // namespace

MapPublisher::MapPublisher(const Camera& camera, double interval_s, LcmPublisher& publisher, Ros2Publisher* ros2,
                           Viewer* viewer, BackgroundWork& work)
    : camera_(camera), interval_s_(interval_s), publisher_(publisher), ros2_(ros2), viewer_(viewer), work_(work) {}

void MapPublisher::begin(LiveRun& run) {
  run_ = &run;
  published_changes_ = 0;
  shown_changes_ = -1;
}

void MapPublisher::enterWorld(int world) {
  if (world == world_) return;
  world_ = world;
  published_changes_ = 0;
  shown_changes_ = -1;
}

void MapPublisher::ask() {
  assert(run_);
  is_wanted_ = true;
  run_->askForMap();
}

void MapPublisher::everySecond(Clock::time_point now) {
  publishWhereChanged(now);
  showWhereChanged(now);
}

void MapPublisher::publishWhereChanged(Clock::time_point now) {
  const LiveCounts counts = run_->counts();
  if (interval_s_ <= 0 || now < next_time_ || counts.points == 0 || counts.map_changes == published_changes_) return;
  next_time_ = now + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(interval_s_));
  published_changes_ = counts.map_changes;
  ask();
}

// While someone looks on.
void MapPublisher::showWhereChanged(Clock::time_point now) {
  if (!viewer_ || !viewer_->isWatched()) {
    shown_changes_ = -1;
    return;
  }
  const std::int64_t changes = run_->counts().map_changes;
  if (changes == shown_changes_ || now < next_shown_time_) return;
  next_shown_time_ = now + shown_interval;
  shown_changes_ = changes;
  run_->askForMap();
}

void MapPublisher::mapCame(const std::shared_ptr<const Map>& map) {
  // The world that the camera was in last may be gone: joined to another, or given up.
  const int world = firstKeyframeOf(*map, world_) >= 0 ? world_ : largestWorld(*map);
  if (viewer_) viewer_->map(map, world);
  if (!std::exchange(is_wanted_, false)) return;
  work_.begin([this, map, world, camera = camera_, version = ++version_]() -> BackgroundWork::Completion {
    return [this, world, version, published = publishedMap(*map, world, camera)]() mutable {
      if (ros2_) ros2_->map(published, world, publisher_.robot());
      publisher_.map(version, std::move(published));
    };
  });
}

PublishedMap publishedMap(const Map& map, int world, const Camera& camera) {
  PublishedMap published;
  for (const MapPointRecord& point : mapPointRecords(map, camera)) {
    if (point.world != world) continue;
    published.points.push_back({point.id, point.position.cast<float>(), point.edge_direction.cast<float>()});
  }
  for (const MapLineRecord& line : mapLineRecords(map)) {
    if (line.world != world) continue;
    published.lines.push_back({line.id, line.from.cast<float>(), line.to.cast<float>()});
  }
  return published;
}

int largestWorld(const Map& map) {
  std::map<int, int> keyframes;
  for (const KeyframeRecord& record : keyframeRecords(map)) ++keyframes[record.world];
  const auto largest = std::max_element(keyframes.begin(), keyframes.end(),
                                        [](const auto& a, const auto& b) { return a.second < b.second; });
  return largest == keyframes.end() ? 0 : largest->first;
}

}  // namespace edgeslam
