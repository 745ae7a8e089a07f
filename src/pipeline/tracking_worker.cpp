#include "pipeline/tracking_worker.h"

#include <utility>

namespace edgeslam {
namespace {

constexpr std::size_t longest_reason = 256;
constexpr int frames_with_tracks = 10;  // after a loss: later, hardly a track runs through the last keyframes (P21)

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

TrackingWorker::TrackingWorker(const Camera& camera, const Settings& settings)
    : relocalise_(settings.relocalisation_enabled || settings.mapping.recovery_enabled),
      tracker_(camera, settings.tracking) {
  for (std::string* text : {&outcome_.reason, &result_.reason, &not_found_}) text->reserve(longest_reason);
  outcome_.for_mapping.observations.reserve(static_cast<std::size_t>(settings.tracking.points.count));
}

void TrackingWorker::take(MapUpdate& update) {
  const bool answered = asked_ >= 0 && update.answers >= asked_;
  if (answered && update.found && update.found->frame_index == asked_frame_) {
    tracker_.resume(update.view, update.found->world_T_camera, update.found->covariance, update.found->points);
    found_ = update.found->how;
  } else {
    tracker_.adopt(update.view);
  }
  if (answered) {
    if (asked_frame_ >= 0) not_found_ = update.not_found;
    asked_ = -1;
  }
}

const FrameResult& TrackingWorker::process(std::int64_t index, std::int64_t time_ns, const cv::Mat& grey,
                                           bool mapping_busy, FrameMessages& messages) {
  tracker_.track(index, time_ns, grey, mapping_busy, outcome_);
  if (outcome_.tells_mapping) std::swap(nextMessage(messages).frame, outcome_.for_mapping);
  makeResult(index, time_ns);
  FrameResult& result = result_;
  if (result.state == TrackingState::lost) {
    ++lost_frames_;
    if (!not_found_.empty()) result.reason.assign("not found again in the map: ").append(not_found_);
    if (relocalise_ && !mapping_busy && asked_ < 0 && tracker_.hasLostFrame()) askWhere(time_ns, nextMessage(messages));
  }
  if (result.state == TrackingState::tracking) {
    lost_frames_ = 0;
    asked_frame_ = -1;
    not_found_.clear();
    last_good_pose_ = result.world_T_camera;
    last_good_ns_ = time_ns;
    if (found_) result.state = *found_;
    found_.reset();
  }
  return result;
}

// As made anew, but with its memory.
MappingMessage& TrackingWorker::nextMessage(FrameMessages& messages) {
  MappingMessage& message = messages.add();
  message.number = next_message_++;
  message.lost = message.recover = false;
  message.edges.reset();
  message.last_good_pose.reset();
  message.seconds_since = 0;
  return message;
}

void TrackingWorker::askWhere(std::int64_t time_ns, MappingMessage& message) {
  asked_ = message.number;
  tracker_.keepLostFrame(message.frame);
  message.lost = true;
  message.edges = tracker_.keptEdges();
  message.last_good_pose = last_good_pose_;
  message.seconds_since = static_cast<double>(time_ns - last_good_ns_) * 1e-9;
  message.recover = last_good_pose_ && lost_frames_ <= frames_with_tracks;
  asked_frame_ = message.frame.frame_index;
}

const FrameResult& TrackingWorker::skip(std::int64_t index, std::int64_t time_ns, const std::string& problem) {
  tracker_.skip(time_ns, problem, outcome_);
  return makeResult(index, time_ns);
}

const FrameResult& TrackingWorker::makeResult(std::int64_t index, std::int64_t time_ns) {
  result_.index = index;
  result_.time_ns = time_ns;
  result_.state = stateOf(outcome_.state);
  result_.reason = outcome_.reason;
  result_.has_pose = outcome_.state == FrameState::tracking || outcome_.state == FrameState::predicted;
  result_.world_T_camera = outcome_.world_T_camera;
  result_.covariance = outcome_.covariance;
  result_.world_covariance = outcome_.world_covariance;
  const bool carried = outcome_.state == FrameState::tracking;
  result_.reference = carried ? outcome_.reference : -1;
  result_.reference_T_camera = carried ? outcome_.reference_T_camera : Pose();
  result_.tracked_points = outcome_.tracked_points;
  result_.mapped_points = outcome_.mapped_points;
  result_.times = outcome_.times;
  return result_;
}

}  // namespace edgeslam
