#include "mapping/mapper.h"

#include <algorithm>

namespace edgeslam {

void Mapper::goOnWith(Map map) {
  map_ = std::move(map);
  description_ = "a saved map";
  renewUncertainty(camera_, options_.uncertainty, map_);
  initialised_ = true;
  ++version_;
}

bool Mapper::add(const TrackedFrame& frame) {
  if (frame.kind == FrameKind::first) {
    initialised_ = false;
    map_ = Map();
    candidates_.clear();
    origin_frame_ = frame.frame_index;
    initialisation_.start(frame);
    return false;
  }
  if (initialised_) {
    if (frame.kind == FrameKind::start) {  // was on its way when the map came to stand
      const std::optional<Pose> pose = initialisation_.locate(frame, early_poses_.back().second);
      if (pose) early_poses_.emplace_back(frame.frame_index, *pose);
      return false;
    }
    addKeyframe(frame);
    return true;
  }
  const std::string waited_for = initialisation_.waitingFor();
  if (initialisation_.add(frame)) {
    initialised_ = true;
    map_ = initialisation_.map();
    renewUncertainty(camera_, options_.uncertainty, map_);
    description_ = initialisation_.description();
    early_poses_ = initialisation_.earlyPoses();
  } else if (!initialisation_.changed() && initialisation_.waitingFor() == waited_for) {
    return false;
  }
  ++version_;
  return true;
}

void Mapper::addKeyframe(const TrackedFrame& frame) {
  Keyframe keyframe;
  keyframe.id = std::max(frame.keyframe, map_.keyframes.back().id + 1);
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
  const std::vector<CulledKeyframe> culled = cullKeyframes(options_.culling, map_, candidates_);
  culled_.insert(culled_.end(), culled.begin(), culled.end());
  addUncertainty(camera_, options_.uncertainty, map_);
  ++version_;
}

RecoveryResult Mapper::recover(const TrackedFrame& lost) {
  RecoveryResult result;
  if (!options_.recovery_enabled || !initialised_ || map_.keyframes.size() < 2) {
    result.reason = "no map to go on from";
    return result;
  }
  const Keyframe& last = map_.keyframes.back();
  result = recoverTrackLoss(camera_, map_.keyframes.atPlace(map_.keyframes.size() - 2), last, lost, options_.recovery);
  if (!result.found) return result;
  for (const RecoveredPoint& recovered : result.points) {
    MapPoint point;
    point.id = recovered.id;
    point.host = last.id;
    point.host_bearing = recovered.host_bearing;
    point.inverse_depth = recovered.inverse_depth;
    point.inverse_depth_sigma = recovered.inverse_depth_sigma;
    point.corner = recovered.corner;
    point.chain_keyframe = last.id;
    point.chain = recovered.chain;
    point.order = recovered.order;
    map_.points.emplace(point.id, std::move(point));  // what is mapped already keeps its place
    candidates_.erase(recovered.id);
  }
  TrackedFrame found = lost;
  found.world_T_camera = result.world_T_camera;
  found.reason = "recovery";
  addKeyframe(found);
  return result;
}

void Mapper::apply(const MapChange& change) {
  applyChange(change, map_);
  renewUncertainty(camera_, options_.uncertainty, map_);
  ++version_;
}

MapView Mapper::view(KeyframeId centre) const {
  MapView view;
  if (initialised_) {
    view = viewOfMap(map_, centre >= 0 ? centre : map_.keyframes.back().id, options_.view);
  } else {
    initialisation_.writeProvisional(view);
    view.waiting_for = initialisation_.waitingFor();
  }
  view.initialised = initialised_;
  view.version = version_;
  view.origin_frame = origin_frame_;
  reserveForTracking(view);
  return view;
}

std::vector<std::pair<std::int64_t, Pose>> Mapper::earlyPoses() const {
  if (map_.keyframes.empty()) return {};
  auto poses = early_poses_;
  for (auto& [frame, pose] : poses) pose = map_.keyframes.front().world_T_camera * pose;
  return poses;
}

}  // namespace edgeslam
