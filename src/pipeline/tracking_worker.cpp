#include "pipeline/tracking_worker.h"

#include <utility>

namespace edgeslam {
namespace {

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

FrameResult resultOf(std::int64_t index, std::int64_t time_ns, TrackingOutcome outcome) {
  FrameResult result;
  result.index = index;
  result.time_ns = time_ns;
  result.state = stateOf(outcome.state);
  result.reason = std::move(outcome.reason);
  result.has_pose = outcome.state == FrameState::tracking || outcome.state == FrameState::predicted;
  result.world_T_camera = outcome.world_T_camera;
  result.covariance = outcome.covariance;
  if (outcome.state == FrameState::tracking) {
    result.reference = outcome.reference;
    result.reference_T_camera = outcome.reference_T_camera;
  }
  result.tracked_points = outcome.tracked_points;
  result.mapped_points = outcome.mapped_points;
  result.times = outcome.times;
  return result;
}

}  // namespace

void TrackingWorker::take(const MapUpdate& update) {
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

FrameResult TrackingWorker::process(std::int64_t index, std::int64_t time_ns, const cv::Mat& grey,
                                    std::vector<MappingMessage>& messages) {
  TrackingOutcome outcome = tracker_.track(index, time_ns, grey);
  for (TrackedFrame& frame : outcome.for_mapping) {
    MappingMessage& message = messages.emplace_back();
    message.number = next_message_++;
    message.frame = std::move(frame);
  }
  FrameResult result = resultOf(index, time_ns, std::move(outcome));
  if (result.state == TrackingState::lost) {
    ++lost_frames_;
    if (!not_found_.empty()) result.reason = "not found again in the map: " + not_found_;
    if (relocalise_ && asked_ < 0 && tracker_.hasLostFrame()) askWhere(time_ns, messages.emplace_back());
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

void TrackingWorker::askWhere(std::int64_t time_ns, MappingMessage& message) {
  message.number = asked_ = next_message_++;
  message.frame = tracker_.keepLostFrame();
  message.lost = true;
  message.edges = tracker_.keptEdges();
  message.last_good_pose = last_good_pose_;
  message.seconds_since = static_cast<double>(time_ns - last_good_ns_) * 1e-9;
  message.recover = last_good_pose_ && lost_frames_ <= frames_with_tracks;
  asked_frame_ = message.frame.frame_index;
}

FrameResult TrackingWorker::skip(std::int64_t index, std::int64_t time_ns, const std::string& problem) const {
  return resultOf(index, time_ns, tracker_.skip(time_ns, problem));
}

}  // namespace edgeslam
