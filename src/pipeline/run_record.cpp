#include "pipeline/run_record.h"

#include <algorithm>
#include <utility>

#include "pipeline/map_records.h"

namespace edgeslam {

FrameRecord& RunRecord::add(const FrameResult& frame, bool unreadable) {
  if (unreadable) ++result_.unreadable_frames;
  FrameRecord& record = result_.frames.emplace_back();
  static_cast<FrameResult&>(record) = frame;
  carried_.push_back({frame.reference, frame.reference_T_camera});
  return record;
}

void RunRecord::add(MappingReport report) {
  for (const std::string& event : report.events) {
    result_.events.push_back("frame " + std::to_string(report.frame_index) + ": " + event);
  }
  for (const CulledKeyframe& culled : report.culled) culled_[culled.id] = culled;
  if (report.loop) result_.closed_loops.push_back(std::move(*report.loop));
  if (!report.found) return;
  ++(report.found->how == TrackingState::recovered ? result_.recoveries : result_.relocalisations);
  const std::size_t place = placeOf(report.frame_index);
  if (place < carried_.size()) carried_[place] = {report.found->reference, report.found->reference_T_camera};
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
std::optional<Pose> RunRecord::finalPose(const Map& map, const CarriedPose& carried) const {
  KeyframeId reference = carried.reference;
  Pose reference_T_camera = carried.reference_T_camera;
  while (!map.keyframes.contains(reference)) {
    const auto culled = culled_.find(reference);
    if (culled == culled_.end()) return std::nullopt;
    reference_T_camera = culled->second.kept_T_culled * reference_T_camera;
    reference = culled->second.kept;
  }
  return map.keyframes[reference].world_T_camera * reference_T_camera;
}

RunResult RunRecord::finish(const Mapper& mapper) {
  if (!mapper.initialised()) return std::move(result_);
  const Map& map = mapper.map();
  for (std::size_t i = 0; i < result_.frames.size(); ++i) {
    const std::optional<Pose> pose = finalPose(map, carried_[i]);
    if (!pose) continue;
    result_.frames[i].has_final_pose = true;
    result_.frames[i].final_world_T_camera = *pose;
  }
  for (const auto& [index, pose] : mapper.earlyPoses()) {
    const std::size_t place = placeOf(index);
    if (place == result_.frames.size() || result_.frames[place].has_final_pose) continue;
    result_.frames[place].has_final_pose = true;
    result_.frames[place].final_world_T_camera = pose;
  }
  for (const Keyframe& keyframe : map.keyframes) {
    if (keyframe.id < first_keyframe_) continue;
    const std::size_t place = placeOf(keyframe.frame_index);
    if (place < result_.frames.size()) result_.frames[place].is_keyframe = true;
  }
  result_.keyframes = keyframeRecords(map, first_keyframe_);
  result_.map_points = mapPointRecords(map, result_.camera);
  result_.initialisation = mapper.initialisationDescription();
  return std::move(result_);
}

}  // namespace edgeslam
