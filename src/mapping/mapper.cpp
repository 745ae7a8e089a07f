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
  if (initialised_) {
    view = viewOfMap(map_, options_.view);
  } else {
    initialisation_.writeProvisional(view);
    view.waiting_for = initialisation_.waitingFor();
  }
  view.initialised = initialised_;
  view.version = version_;
  view.origin_frame = origin_frame_;
  return view;
}

std::vector<std::pair<std::int64_t, Pose>> Mapper::earlyPoses() const {
  if (map_.keyframes.empty()) return {};
  auto poses = early_poses_;
  for (auto& [frame, pose] : poses) pose = map_.keyframes.front().world_T_camera * pose;
  return poses;
}

}  // namespace edgeslam
