#include "pipeline/lockstep_run.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <limits>
#include <utility>

#include "pipeline/frame_drawing.h"

namespace edgeslam {
namespace {

double millisecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

LockstepRun::LockstepRun(const Camera& camera, const Settings& settings, std::int64_t expected_frames, int drawings)
    : settings_(settings),
      tracking_(camera, settings),
      mapping_(camera, settings),
      places_(camera, settings),
      record_(camera, settings.tracking.location.pose) {
  if (drawings <= 0) {
    drawing_interval_ = 0;
  } else if (expected_frames > 0) {
    drawing_interval_ = std::max<std::int64_t>(1, expected_frames / drawings);
  }
}

void LockstepRun::repeat(RunDecisions decisions) {
  assert(processed_ == 0);
  recorded_ = std::move(decisions);
}

void LockstepRun::goOnWith(Map map) {
  assert(processed_ == 0 && !map.keyframes.empty());
  const PointId first_free_point = firstFreePoint(map);
  record_.goOnFrom(map.keyframes.back().id + 1);
  mapping_.goOnWith(std::move(map));
  tracking_.goOnWith(mapping_.mapper().view(), first_free_point);
}

const FrameRecord& LockstepRun::process(std::int64_t index, std::int64_t time_ns, const cv::Mat& grey) {
  takeDueUpdate(index);
  takeRecorded(index);
  messages_.clear();
  const bool mapping_busy = recorded_ && recorded_->mapping_busy.count(index) > 0;
  latest_ = &tracking_.process(index, time_ns, grey, mapping_busy, messages_);
  FrameRecord& frame = record_.add(*latest_, /*unreadable=*/false);
  const auto start = std::chrono::steady_clock::now();
  for (MappingMessage& message : messages_) hand(message);
  frame.times.add(Stage::mapping, millisecondsSince(start));
  for (MappingReport& report : mapping_.takeReports()) record_.add(std::move(report));
  if (drawing_interval_ > 0 && processed_ % drawing_interval_ == 0) draw(grey, frame);
  ++processed_;
  return frame;
}

const FrameRecord& LockstepRun::skip(std::int64_t index, std::int64_t time_ns, const std::string& problem) {
  takeDueUpdate(index);
  takeRecorded(index);
  ++processed_;
  latest_ = &tracking_.skip(index, time_ns, problem);
  return record_.add(*latest_, /*unreadable=*/true);
}

// The newest of those due; what it knows includes what the others knew.
void LockstepRun::takeDueUpdate(std::int64_t frame_index) {
  std::optional<MapUpdate> newest;
  for (; !updates_.empty() && isDue(updates_.front(), frame_index); updates_.pop_front()) {
    newest = std::move(updates_.front().update);
  }
  if (newest) tracking_.take(*newest);
}

// What the live run had been given of its sensors.
void LockstepRun::takeRecorded(std::int64_t frame_index) {
  if (!recorded_) return;
  const auto give = [&](const auto& measured) {
    const auto found = measured.find(frame_index);
    if (found == measured.end()) return;
    for (const auto& sample : found->second) tracking_.add(sample);
  };
  give(recorded_->inertia);
  give(recorded_->wheels);
}

bool LockstepRun::isDue(const DueUpdate& update, std::int64_t frame_index) const {
  if (!recorded_) return update.due <= processed_;
  const auto taken = recorded_->updates.find(frame_index);
  return taken != recorded_->updates.end() && update.update.number <= taken->second;
}

void LockstepRun::hand(MappingMessage& message) {
  if (!recorded_ && message.frame.kind != FrameKind::lost) applyDueCorrections(keyframes_ + 1);
  remember(mapping_.handle(message));
  if (mapping_.hasNewKeyframe()) {
    tracking_.dropUnusedImages();
    ++keyframes_;
    // At once, though it is applied later: what waits is a correction and not a copy of the map.
    if (placesSaw(mapping_.lastMessage())) {
      corrections_.push_back({keyframes_ + settings_.correction_delay_keyframes, places_.work(*mapping_.mapInPlace())});
    }
  }
  if (recorded_) applyRecordedCorrections(message.number + 1);
}

// The map as it was after this message.
bool LockstepRun::placesSaw(std::int64_t message) const {
  return !recorded_ || recorded_->snapshots.count(message) > 0;
}

// Those due before keyframe number `keyframes`.
void LockstepRun::applyDueCorrections(std::int64_t keyframes) {
  for (; !corrections_.empty() && corrections_.front().due <= keyframes; corrections_.pop_front()) {
    remember(mapping_.apply(corrections_.front().correction));
  }
}

// Those applied before `message`.
void LockstepRun::applyRecordedCorrections(std::int64_t message) {
  const auto applied = recorded_->corrections.find(message);
  if (applied == recorded_->corrections.end()) return;
  for (const std::int64_t number : applied->second) {
    if (corrections_.empty() || corrections_.front().correction.number != number) return;  // it is of another run
    remember(mapping_.apply(corrections_.front().correction));
    corrections_.pop_front();
  }
}

void LockstepRun::remember(std::optional<MapUpdate> update) {
  if (!update) return;
  updates_.push_back({processed_ + std::max(1, settings_.view_delay_frames), std::move(*update)});
}

void LockstepRun::draw(const cv::Mat& grey, const FrameRecord& record) {
  const Tracker& tracker = tracking_.tracker();
  const EdgeMap no_edges;
  const EdgeMap* edges = tracker.latestEdges();
  const std::vector<Track> none;
  std::vector<DrawnTrack> tracks;
  // Where this frame was lost, the tracker's are of an earlier one.
  for (const Track& track : tracker.latestIsTracked() ? tracker.tracks() : none) {
    DrawnTrack drawn;
    drawn.pixel = track.pixel;
    drawn.keyframe_pixel = track.last_keyframe_pixel;
    drawn.normal = track.normal;
    drawn.mapped = findPoint(tracker.view(), track.id) != nullptr;
    drawn.corner = track.corner;
    tracks.push_back(drawn);
  }
  const std::string caption = "frame " + std::to_string(record.index) + ": " + stateName(record.state) +
                              (record.reason.empty() ? "" : " (" + record.reason + ")");
  record_.add({record.index, drawFrame(grey, edges ? *edges : no_edges, tracks, caption)});
}

void LockstepRun::settle() {
  if (!recorded_) applyDueCorrections(std::numeric_limits<std::int64_t>::max());
  for (MappingReport& report : mapping_.takeReports()) record_.add(std::move(report));
}

RunResult LockstepRun::finish() {
  settle();
  return record_.finish(mapping_.mapper());
}

}  // namespace edgeslam
