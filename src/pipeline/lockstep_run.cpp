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

Eigen::Matrix<float, 6, 1> standardDeviation(const Matrix6d& covariance) {
  return covariance.diagonal().cwiseMax(0).cwiseSqrt().cast<float>();
}

double millisecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

PointId largestPoint(const Map& map) {
  PointId largest = -1;
  for (const Keyframe& keyframe : map.keyframes) {
    if (!keyframe.observations.empty()) largest = std::max(largest, keyframe.observations.back().point);
  }
  return largest;
}

std::vector<TimedPose> keyframePath(const Map& map) {
  std::vector<TimedPose> path;
  for (const Keyframe& keyframe : map.keyframes) path.push_back({keyframe.time_ns, keyframe.world_T_camera});
  return path;
}

}  // namespace

LockstepRun::LockstepRun(const Camera& camera, const Settings& settings, std::int64_t expected_frames, int drawings)
    : settings_(settings),
      tracker_(camera, settings.tracking),
      mapper_(camera, settings.mapping),
      relocalisation_(camera, settings.relocalisation),
      loop_closing_(camera, settings.loops) {
  result_.camera = camera;
  if (drawings <= 0) {
    drawing_interval_ = 0;
  } else if (expected_frames > 0) {
    drawing_interval_ = std::max<std::int64_t>(1, expected_frames / drawings);
  }
}

void LockstepRun::goOnWith(Map map) {
  const PointId first_free_point = largestPoint(map) + 1;
  first_keyframe_ = map.keyframes.back().id + 1;
  mapper_.goOnWith(std::move(map));
  relocalisation_.update(mapper_.map());
  tracker_.startLost(mapper_.view(), first_free_point);
}

const FrameRecord& LockstepRun::process(std::int64_t index, std::int64_t time_ns, const cv::Mat& grey) {
  takeDueViews();
  const TrackingOutcome outcome = tracker_.track(index, time_ns, grey);
  FrameRecord& frame = record(index, time_ns, outcome);
  hand(outcome.for_mapping, frame);
  lost_frames_ = frame.state == TrackingState::lost ? lost_frames_ + 1 : 0;
  if (lost_frames_ > 0) findAgain(frame);
  if (isGoodPose(frame.state)) {
    last_good_pose_ = frame.live_world_T_camera;
    last_good_ns_ = time_ns;
  }
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

void LockstepRun::hand(const std::vector<TrackedFrame>& frames, FrameRecord& record) {
  const auto start = std::chrono::steady_clock::now();
  for (const TrackedFrame& frame : frames) {
    std::optional<MapView> view = mapper_.add(frame);
    if (!view) continue;
    if (mapper_.initialised()) lookForLoop(record);
    for (const CulledKeyframe& culled : mapper_.takeCulled()) culled_[culled.id] = culled;
    views_.push_back({processed_ + std::max(1, settings_.view_delay_frames), mapper_.view()});
  }
  record.times.add(Stage::mapping, millisecondsSince(start));
}

// Places: the new keyframes are made known to relocalisation, and compared with the old ones.
void LockstepRun::lookForLoop(FrameRecord& record) {
  const Map& map = mapper_.map();
  relocalisation_.update(map);
  if (!settings_.loops.enabled) {
    mapper_.adjustAll(false);
    return;
  }
  ClosedLoop loop{record.index, map.keyframes.back().id, "", keyframePath(map), {}};
  const LoopOutcome outcome = loop_closing_.addKeyframe(map);
  for (const JudgedLoop& judged : outcome.considered) {
    tell(record, "loop of keyframe " + std::to_string(outcome.current) + " to keyframe " +
                     std::to_string(judged.keyframe) + (judged.accepted ? " closed: " : " refused: ") + judged.reason);
  }
  if (outcome.correction) {
    mapper_.correct([&](Map& corrected) { applyCorrection(*outcome.correction, corrected); });
    loop.how = "by its looks";
  } else if (mapper_.metOldMap()) {
    tell(record, "an old part of the map is met again by its points");
    loop.how = "by its points";
  }
  mapper_.adjustAll(!loop.how.empty());
  if (loop.how.empty()) return;
  loop.after = keyframePath(map);
  result_.closed_loops.push_back(std::move(loop));
}

// The frame's pose is lost: recovery by its tracks (P21), then the map as a whole (P22).
void LockstepRun::findAgain(FrameRecord& record) {
  if (!tracker_.hasLostFrame() || !mapper_.initialised()) return;
  const auto start = std::chrono::steady_clock::now();
  const auto next_keyframe = mapper_.map().keyframes.back().id + 1;
  if (last_good_pose_ && lost_frames_ <= 10) {
    const RecoveryResult recovery = mapper_.recover(tracker_.lostFrame(next_keyframe));
    if (recovery.found) {
      ++result_.recoveries;
      tell(record, "recovered from three keyframes, " + std::to_string(recovery.inliers) + " points");
      const Pose pose = mapper_.map().keyframes.back().world_T_camera;
      goOnFrom(record, TrackingState::recovered, pose, recovery.covariance, next_keyframe, {});
    }
  }
  if (record.state == TrackingState::lost && settings_.relocalisation_enabled &&
      lost_frames_ % std::max(1, settings_.relocalisation_interval) == 0) {
    // What looks like a place out of reach is another place that looks the same.
    std::optional<Reachable> reachable;
    const double seconds = static_cast<double>(record.time_ns - last_good_ns_) * 1e-9;
    if (last_good_pose_) reachable = reachableFrom(mapper_.map(), *last_good_pose_, seconds);
    const RelocalisationResult found =
        relocalisation_.relocalise(mapper_.map(), tracker_.lostImages(), tracker_.lostEdges(), reachable);
    if (found.found) {
      ++result_.relocalisations;
      tell(record, "relocalised at keyframe " + std::to_string(found.keyframe) + ", " +
                       std::to_string(found.evidence.inliers) + " of " + std::to_string(found.evidence.visible) +
                       " points");
      std::vector<FoundAgain> points;
      for (const MatchedPoint& match : found.matches) points.push_back({match.point, match.measurement, match.corner});
      goOnFrom(record, TrackingState::relocalised, found.world_T_camera, found.pose.covariance, found.keyframe, points);
    } else {
      record.reason = "not found again in the map: " + found.reason;
    }
  }
  record.times.add(Stage::places, millisecondsSince(start));
}

void LockstepRun::goOnFrom(FrameRecord& record, TrackingState state, const Pose& world_T_camera,
                           const Matrix6d& covariance, KeyframeId centre, const std::vector<FoundAgain>& points) {
  views_.clear();
  tracker_.resume(mapper_.view(centre), world_T_camera, covariance, points);
  record.state = state;
  record.reason.clear();
  record.has_live_pose = true;
  record.live_world_T_camera = world_T_camera;
  record.standard_deviation = standardDeviation(covariance);
  record.mapped_points = static_cast<int>(points.size());
  carried_.back() = {centre, mapper_.map().keyframes[centre].world_T_camera.inverse() * world_T_camera};
  lost_frames_ = 0;
}

void LockstepRun::tell(const FrameRecord& record, const std::string& event) {
  result_.events.push_back("frame " + std::to_string(record.index) + ": " + event);
}

FrameRecord& LockstepRun::record(std::int64_t index, std::int64_t time_ns, const TrackingOutcome& outcome) {
  FrameRecord frame;
  frame.index = index;
  frame.time_ns = time_ns;
  frame.state = stateOf(outcome.state);
  frame.reason = outcome.reason;
  frame.has_live_pose = outcome.state == FrameState::tracking || outcome.state == FrameState::predicted;
  frame.live_world_T_camera = outcome.world_T_camera;
  frame.standard_deviation = standardDeviation(outcome.covariance);
  frame.tracked_points = outcome.tracked_points;
  frame.mapped_points = outcome.mapped_points;
  frame.times = outcome.times;
  carried_.push_back({outcome.state == FrameState::tracking ? outcome.reference : -1, outcome.reference_T_camera});
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

// The frame's pose is carried by its keyframe, or, where that was culled, by the one that stands for it.
std::optional<Pose> LockstepRun::finalPose(KeyframeId reference, Pose reference_T_camera) const {
  const Map& map = mapper_.map();
  while (!map.keyframes.contains(reference)) {
    const auto culled = culled_.find(reference);
    if (culled == culled_.end()) return std::nullopt;
    reference_T_camera = culled->second.kept_T_culled * reference_T_camera;
    reference = culled->second.kept;
  }
  return map.keyframes[reference].world_T_camera * reference_T_camera;
}

RunResult LockstepRun::finish() {
  if (!mapper_.initialised()) return std::move(result_);
  const Map& map = mapper_.map();
  for (std::size_t i = 0; i < result_.frames.size(); ++i) {
    const std::optional<Pose> pose = finalPose(carried_[i].reference, carried_[i].reference_T_camera);
    if (!pose) continue;
    result_.frames[i].has_final_pose = true;
    result_.frames[i].final_world_T_camera = *pose;
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
    if (keyframe.id < first_keyframe_) continue;
    const auto frame = frameOf(keyframe.frame_index);
    if (frame != result_.frames.end() && frame->index == keyframe.frame_index) frame->is_keyframe = true;
  }
  result_.keyframes = keyframeRecords(map, first_keyframe_);
  result_.map_points = mapPointRecords(map, result_.camera);
  result_.initialisation = mapper_.initialisationDescription();
  return std::move(result_);
}

}  // namespace edgeslam
