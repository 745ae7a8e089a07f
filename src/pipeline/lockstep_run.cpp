#include "pipeline/lockstep_run.h"

#include <algorithm>
#include <chrono>

#include "pipeline/frame_drawing.h"
#include "pipeline/map_records.h"

namespace edgeslam {
namespace {

TrackingState stateOf(FrameState state) {
  switch (state) {
    case FrameState::initialising:
      return TrackingState::initialising;
    case FrameState::tracking:
      return TrackingState::tracking;
    case FrameState::predicted:
      return TrackingState::predicted;
    case FrameState::lost:
      return TrackingState::lost;
  }
  return TrackingState::lost;
}

}  // namespace

LockstepRun::LockstepRun(const Camera& camera, const Settings& settings, std::int64_t expected_frames, int drawings)
    : settings_(settings), tracker_(camera, settings.tracking), mapper_(camera, settings.mapping) {
  result_.camera = camera;
  if (drawings <= 0) {
    drawing_interval_ = 0;
  } else if (expected_frames > 0) {
    drawing_interval_ = std::max<std::int64_t>(1, expected_frames / drawings);
  }
}

const FrameRecord& LockstepRun::process(std::int64_t index, std::int64_t time_ns, const cv::Mat& grey) {
  takeDueViews();
  TrackingOutcome outcome = tracker_.track(index, time_ns, grey);
  FrameRecord& frame = record(index, time_ns, outcome);
  hand(std::move(outcome.for_mapping), frame);
  if (drawing_interval_ > 0 && processed_ % drawing_interval_ == 0) draw(grey, frame);
  ++processed_;
  return frame;
}

const FrameRecord& LockstepRun::skip(std::int64_t index, std::int64_t time_ns, const std::string& problem) {
  ++result_.unreadable_frames;
  FrameRecord& frame = record(index, time_ns, tracker_.skip(time_ns, problem));
  ++processed_;
  return frame;
}

void LockstepRun::takeDueViews() {
  while (!views_.empty() && views_.front().due <= processed_) {
    tracker_.adopt(views_.front().view);
    views_.pop_front();
  }
}

void LockstepRun::hand(std::vector<TrackedFrame> frames, FrameRecord& record) {
  const auto start = std::chrono::steady_clock::now();
  for (const TrackedFrame& frame : frames) {
    if (std::optional<MapView> view = mapper_.add(frame)) {
      views_.push_back({processed_ + std::max(1, settings_.view_delay_frames), std::move(*view)});
    }
  }
  record.stage_ms["mapping"] =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

FrameRecord& LockstepRun::record(std::int64_t index, std::int64_t time_ns, const TrackingOutcome& outcome) {
  FrameRecord frame;
  frame.index = index;
  frame.time_ns = time_ns;
  frame.state = stateOf(outcome.state);
  frame.reason = outcome.reason;
  frame.has_live_pose = outcome.state == FrameState::tracking || outcome.state == FrameState::predicted;
  frame.live_world_T_camera = outcome.world_T_camera;
  frame.covariance = outcome.covariance;
  frame.tracked_points = outcome.tracked_points;
  frame.mapped_points = outcome.mapped_points;
  for (const auto& [stage, milliseconds] : outcome.times) frame.stage_ms[stage] = milliseconds;
  references_.push_back(outcome.state == FrameState::tracking ? outcome.reference : -1);
  reference_T_camera_.push_back(outcome.reference_T_camera);
  result_.frames.push_back(std::move(frame));
  return result_.frames.back();
}

void LockstepRun::draw(const cv::Mat& grey, const FrameRecord& record) {
  std::vector<DrawnTrack> tracks;
  for (const Track& track : tracker_.tracks()) {
    DrawnTrack drawn;
    drawn.pixel = track.pixel;
    drawn.keyframe_pixel = track.last_keyframe_pixel;
    drawn.normal = track.normal;
    drawn.mapped = findPoint(tracker_.view(), track.id) != nullptr;
    drawn.corner = track.corner;
    tracks.push_back(drawn);
  }
  const std::string caption = "frame " + std::to_string(record.index) + ": " + stateName(record.state) +
                              (record.reason.empty() ? "" : " (" + record.reason + ")");
  result_.drawings.push_back({record.index, drawFrame(grey, tracker_.edges(), tracks, caption)});
}

RunResult LockstepRun::finish() {
  if (!mapper_.initialised()) return std::move(result_);
  const Map& map = mapper_.map();
  for (std::size_t i = 0; i < result_.frames.size(); ++i) {
    const KeyframeId reference = references_[i];
    if (reference < 0 || static_cast<std::size_t>(reference) >= map.keyframes.size()) continue;
    result_.frames[i].has_final_pose = true;
    result_.frames[i].final_world_T_camera =
        map.keyframes[static_cast<std::size_t>(reference)].world_T_camera * reference_T_camera_[i];
  }
  const auto frameOf = [&](std::int64_t index) {
    return std::lower_bound(result_.frames.begin(), result_.frames.end(), index,
                            [](const FrameRecord& frame, std::int64_t wanted) { return frame.index < wanted; });
  };
  for (const auto& [index, pose] : mapper_.earlyPoses()) {
    const auto frame = frameOf(index);
    if (frame == result_.frames.end() || frame->index != index || frame->has_final_pose) continue;
    frame->has_final_pose = true;
    frame->final_world_T_camera = pose;
  }
  for (const Keyframe& keyframe : map.keyframes) {
    const auto frame = frameOf(keyframe.frame_index);
    if (frame != result_.frames.end() && frame->index == keyframe.frame_index) frame->is_keyframe = true;
  }
  result_.keyframes = keyframeRecords(map);
  result_.map_points = mapPointRecords(map, result_.camera);
  result_.initialisation = mapper_.initialisationDescription();
  return std::move(result_);
}

}  // namespace edgeslam
