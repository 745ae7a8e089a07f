#include "pipeline/tracking_worker.h"

#include <limits>
#include <utility>

namespace edgeslam {
namespace {

constexpr std::int64_t search_interval_ns = 100'000'000;  // while a world is begun, which must not wait for searches
constexpr std::int64_t doubt_interval_ns =
    200'000'000;                        // while poses are in doubt, and mapping has keyframes to see to
constexpr int frames_with_tracks = 10;  // after a loss: later, hardly a track runs through the last keyframes (P21)

}  // namespace

TrackingWorker::TrackingWorker(const Camera& camera, const Settings& settings)
    : recovers_(settings.mapping.recovery_enabled && !settings.tracking.map_is_frozen),
      is_looked_for_(settings.relocalisation_enabled || recovers_),
      tracker_(camera, settings.edges, settings.points, settings.tracking) {
  reserve(static_cast<std::size_t>(settings.points.count), result_);
  for (std::string* text : {&not_found_, &start_reason_}) text->reserve(longest_reason);
  reserve(static_cast<std::size_t>(settings.points.count), settings.tracking.inertia.has_value(), for_mapping_);
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
  FrameResult& result = result_;
  const bool is_told = tracker_.track(index, time_ns, grey, mapping_busy, result, for_mapping_);
  if (is_told) std::swap(nextMessage(messages).frame, for_mapping_);
  if (result.state == TrackingState::lost) {
    ++lost_frames_;
    if (!not_found_.empty()) result.reason.assign("not found again in the map: ").append(not_found_);
  }
  if (tracker_.startsBesideOthers()) {
    start_reason_.assign("beside the map that was lost: ").append(result.reason);
    result.reason.assign(start_reason_);
  }
  if (!mapping_busy && isToAskWhere(time_ns)) askWhere(time_ns, nextMessage(messages));
  // A pose by inertia alone does not end the search for the frame, nor does one in doubt.
  if (result.state == TrackingState::tracking && tracker_.latestIsTracked()) {
    lost_frames_ = 0;
    if (!tracker_.lastBeforeDoubt()) asked_frame_ = -1;
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
  message.recover = message.starting = false;
  message.edges.reset();
  message.latest_believed = std::numeric_limits<KeyframeId>::max();
  message.last_good_pose.reset();
  message.seconds_since = 0;
  return message;
}

bool TrackingWorker::isToAskWhere(std::int64_t time_ns) const {
  if (!is_looked_for_ || asked_ >= 0) return false;
  if (isInDoubt()) return time_ns - asked_ns_ >= doubt_interval_ns;
  return tracker_.hasLostFrame() || (tracker_.startsBesideOthers() && time_ns - asked_ns_ >= search_interval_ns);
}

bool TrackingWorker::isInDoubt() const {
  return tracker_.lastBeforeDoubt() && !tracker_.hasLostFrame() && tracker_.latestIsTracked();
}

void TrackingWorker::askWhere(std::int64_t time_ns, MappingMessage& message) {
  asked_ = message.number;
  asked_ns_ = time_ns;
  message.starting = !tracker_.hasLostFrame() && !isInDoubt();
  if (tracker_.hasLostFrame()) {
    tracker_.keepLostFrame(message.frame);
  } else {
    tracker_.keepLatestFrame(message.frame);
  }
  message.edges = tracker_.keptEdges();
  asked_frame_ = message.frame.frame_index;
  if (const std::optional<ConfirmedPose>& before = tracker_.lastBeforeDoubt()) return lookBefore(*before, message);
  message.last_good_pose = last_good_pose_;
  message.seconds_since = static_cast<double>(time_ns - last_good_ns_) * 1e-9;
  message.recover = recovers_ && !message.starting && last_good_pose_ && lost_frames_ <= frames_with_tracks;
}

// Only in what was mapped before the doubt: what was mapped since says the same again.
void TrackingWorker::lookBefore(const ConfirmedPose& doubt, MappingMessage& message) {
  message.last_good_pose = doubt.world_T_camera;
  message.seconds_since = static_cast<double>(message.frame.time_ns - doubt.time_ns) * 1e-9;
  message.latest_believed = doubt.keyframe;
}

const FrameResult& TrackingWorker::skip(std::int64_t index, std::int64_t time_ns, const std::string& problem) {
  tracker_.skip(index, time_ns, problem, result_);
  return result_;
}

}  // namespace edgeslam
