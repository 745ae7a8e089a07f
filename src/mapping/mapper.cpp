#include "mapping/mapper.h"

#include <algorithm>

namespace edgeslam {

std::optional<MapView> Mapper::add(const TrackedFrame& frame) {
  if (frame.keyframe == 0) {  // a start, or a new one
    initialised_ = false;
    map_ = Map();
    candidates_.clear();
    origin_frame_ = frame.frame_index;
    initialisation_.start(frame);
    return std::nullopt;
  }
  if (initialised_) {
    if (frame.keyframe < 0) return std::nullopt;  // was on its way when the map came to stand
    addKeyframe(frame);
    return view();
  }
  const std::string waited_for = initialisation_.waitingFor();
  if (initialisation_.add(frame)) {
    initialised_ = true;
    map_ = initialisation_.map();
    early_poses_ = initialisation_.earlyPoses();
  } else if (!initialisation_.changed() && initialisation_.waitingFor() == waited_for) {
    return std::nullopt;
  }
  ++version_;
  return view();
}

void Mapper::addKeyframe(const TrackedFrame& frame) {
  Keyframe keyframe;
  keyframe.id = static_cast<KeyframeId>(map_.keyframes.size());
  keyframe.frame_index = frame.frame_index;
  keyframe.time_ns = frame.time_ns;
  keyframe.world_T_camera = frame.world_T_camera;
  keyframe.observations = frame.observations;
  keyframe.images = frame.images;
  keyframe.reason = frame.reason;
  map_.keyframes.push_back(std::move(keyframe));
  associate(map_, candidates_);
  addNewPoints(camera_, options_.new_points, map_, candidates_);
  adjustLocally(camera_, options_.local_adjustment, map_);
  ++version_;
}

MapView Mapper::view() const {
  MapView view;
  view.version = version_;
  view.origin_frame = origin_frame_;
  view.initialised = initialised_;
  if (!initialised_) {
    view.waiting_for = initialisation_.waitingFor();
    initialisation_.writeProvisional(view);
    return view;
  }
  for (const Keyframe& keyframe : map_.keyframes) view.keyframe_poses.push_back(keyframe.world_T_camera);
  const KeyframeId oldest = static_cast<KeyframeId>(map_.keyframes.size()) - options_.view_keyframes;
  for (const auto& [id, point] : map_.points) {
    const KeyframeId last_seen = point.seen_in.empty() ? point.host : std::max(point.host, point.seen_in.back());
    if (last_seen < oldest) continue;
    view.points.push_back({id, point.host, point.host_bearing, point.inverse_depth, point.inverse_depth_sigma});
  }
  return view;
}

std::vector<std::pair<std::int64_t, Pose>> Mapper::earlyPoses() const {
  if (map_.keyframes.empty()) return {};
  auto poses = early_poses_;
  for (auto& [frame, pose] : poses) pose = map_.keyframes.front().world_T_camera * pose;
  return poses;
}

}  // namespace edgeslam
