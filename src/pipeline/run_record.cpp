#include "pipeline/run_record.h"

#include <algorithm>
#include <utility>

#include "pipeline/final_poses.h"
#include "pipeline/map_records.h"
#include "pipeline/metric_result.h"

namespace edgeslam {
FrameRecord& RunRecord::add(const FrameResult& frame, bool unreadable) {
  if (unreadable) ++result_.unreadable_frames;
  FrameRecord& record = result_.frames.emplace_back();
  static_cast<FrameResult&>(record) = frame;
  if (const std::optional<OdometryFrame> odometry = odometry_.next(frame)) {
    record.has_odometry = true;
    record.odom_T_camera = odometry->odom_T_camera;
    record.odometry_resets = odometry->resets;
  }
  carried_.push_back(inWorldOfToday({frame.reference, frame.reference_T_camera, frame.world}));
  keep(record);
  return record;
}

// What it saw is kept until its final pose is found.
void RunRecord::keep(FrameRecord& frame) {
  const bool sees_something = !frame.seen.points.empty();
  seen_.add(frame.seen);
  frame.seen = {};
  if (told_of_seen_ || !sees_something || seen_.problem().empty()) return;
  told_of_seen_ = true;
  result_.events.push_back("frame " + std::to_string(frame.index) + ": no room for what frames see (" +
                           seen_.problem() +
                           "): from here on final poses are as their keyframes carry them; TMPDIR names another disk");
}

void RunRecord::add(MappingReport report) {
  for (const std::string& event : report.events) {
    result_.events.push_back("frame " + std::to_string(report.frame_index) + ": " + event);
  }
  for (const CulledKeyframe& culled : report.culled) culled_[culled.id] = culled;
  if (report.join) join(*report.join);
  if (report.loop) result_.closed_loops.push_back(std::move(*report.loop));
  if (!report.found) return;
  ++(report.found->how == TrackingState::recovered ? result_.recoveries : result_.relocalisations);
  const std::size_t place = placeOf(report.frame_index);
  if (place < carried_.size())
    carried_[place] = {report.found->reference, report.found->reference_T_camera, report.found->world};
}

// What was tracked in a world that was joined to another meanwhile is in the other's unit from then on.
RunRecord::CarriedPose RunRecord::inWorldOfToday(CarriedPose carried) const {
  for (auto join = joins_.find(carried.world); join != joins_.end(); join = joins_.find(carried.world)) {
    carried.reference_T_camera.translation *= join->second.to_S_from.scale;
    carried.world = join->second.to;
  }
  return carried;
}

void RunRecord::join(const WorldJoin& join) {
  joins_[join.from] = join;
  for (CarriedPose& carried : carried_) carried = inWorldOfToday(carried);
  for (auto& [id, culled] : culled_) {
    if (culled.world != join.from) continue;
    culled.kept_T_culled.translation *= join.to_S_from.scale;
    culled.world = join.to;
  }
}

// Of the frame's record; the number of records where there is none.
std::size_t RunRecord::placeOf(std::int64_t frame_index) const {
  const auto& frames = result_.frames;
  const auto found =
      std::lower_bound(frames.begin(), frames.end(), frame_index,
                       [](const FrameRecord& frame, std::int64_t wanted) { return frame.index < wanted; });
  const bool there = found != frames.end() && found->index == frame_index;
  return there ? static_cast<std::size_t>(found - frames.begin()) : frames.size();
}

// Carried by its keyframe, or, where that was culled, by the one that stands for it.
std::optional<WorldPose> RunRecord::finalPose(const Map& map, const CarriedPose& carried) const {
  KeyframeId reference = carried.reference;
  Pose reference_T_camera = carried.reference_T_camera;
  while (!map.keyframes.contains(reference)) {
    const auto culled = culled_.find(reference);
    if (culled == culled_.end()) return std::nullopt;
    reference_T_camera = culled->second.kept_T_culled * reference_T_camera;
    reference = culled->second.kept;
    if (reference < 0) return WorldPose{culled->second.world, reference_T_camera};
  }
  return WorldPose{map.keyframes[reference].world, map.keyframes[reference].world_T_camera * reference_T_camera};
}

void RunRecord::giveFinalPose(std::size_t place, const WorldPose& pose) {
  FrameRecord& frame = result_.frames[place];
  frame.has_final_pose = true;
  frame.final_world = pose.world;
  frame.final_world_T_camera = pose.world_T_camera;
}

int RunRecord::mainWorld() const {
  std::map<int, std::size_t> poses;
  for (const FrameRecord& frame : result_.frames) {
    if (frame.has_final_pose) ++poses[frame.final_world];
  }
  const auto fewer = [](const auto& a, const auto& b) { return a.second < b.second; };
  const auto most = std::max_element(poses.begin(), poses.end(), fewer);
  return most == poses.end() ? 0 : most->first;
}

RunResult RunRecord::finish(const Mapper& mapper) {
  if (!mapper.map().keyframes.empty()) giveMap(mapper);
  return std::move(result_);
}

void RunRecord::giveMap(const Mapper& mapper) {
  const Map& map = mapper.map();
  for (std::size_t i = 0; i < result_.frames.size(); ++i) {
    if (const std::optional<WorldPose> pose = finalPose(map, carried_[i])) giveFinalPose(i, *pose);
  }
  for (const EarlyPose& early : mapper.earlyPoses()) {
    const std::size_t place = placeOf(early.frame_index);
    if (place == result_.frames.size() || result_.frames[place].has_final_pose) continue;
    giveFinalPose(place, {early.world, early.world_T_camera});
  }
  for (const Keyframe& keyframe : map.keyframes) {
    if (keyframe.id < first_keyframe_) continue;
    const std::size_t place = placeOf(keyframe.frame_index);
    if (place < result_.frames.size()) result_.frames[place].is_keyframe = true;
  }
  locateFramesAnew(mapper.camera(), map, pose_, seen_, result_.frames);
  smoothFrames(mapper.camera(), map, pose_, seen_, result_.frames);
  result_.camera = mapper.camera();
  result_.found = map.found;
  result_.time_offset = mapper.foundTimeOffset();
  result_.unit_rotation = mapper.foundUnitRotation();
  result_.keyframes = keyframeRecords(map, first_keyframe_);
  result_.map_points = mapPointRecords(map, result_.camera);
  result_.map_lines = mapLineRecords(map);
  result_.initialisation = mapper.initialisationDescription();
  result_.main_world = mainWorld();
  result_.lacking_for_inertia = mapper.lackingForInertia();
  result_.lacking_for_wheels = mapper.lackingForWheels();
  result_.contradiction_of_wheels = mapper.contradictionOfWheels();
  makeMetric(map, result_);
}

}  // namespace edgeslam
