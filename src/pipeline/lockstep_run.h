// Runs that are a pure function of their input (design, section 4). In lockstep, tracking, mapping and places exchange
// values at fixed frames; a run that repeats a live one exchanges them where that one did.
#pragma once

#include <deque>
#include <vector>

#include "pipeline/mapping_worker.h"
#include "pipeline/places_worker.h"
#include "pipeline/run_decisions.h"
#include "pipeline/run_record.h"
#include "pipeline/tracking_worker.h"

namespace edgeslam {

class LockstepRun {
 public:
  // `drawings`: about so many frames are drawn for the report, out of `expected_frames` (0: unknown, one every 100).
  LockstepRun(const Camera& camera, const Settings& settings, std::int64_t expected_frames, int drawings);

  // Before the first frame: repeats a live run, whose frames are given as it processed them.
  void repeat(RunDecisions decisions);
  // Before the first frame: continues a map made earlier, of the same camera. The camera is somewhere in it.
  void goOnWith(Map map);
  // The map as it is now; without keyframes where none stands yet.
  const Map& map() const { return mapping_.mapper().map(); }

  // What the inertial unit measured until the next frame, in order; and the first that was measured after it.
  void add(const InertialSample& sample) { tracking_.add(sample); }
  // Where the wheels say that the robot was, likewise.
  void add(const OdometryPose& pose) { tracking_.add(pose); }
  // The next frame, CV_8U of the camera's size. Returns its record, without the final pose.
  const FrameRecord& process(std::int64_t index, std::int64_t time_ns, const cv::Mat& grey);
  // A frame that could not be read.
  const FrameRecord& skip(std::int64_t index, std::int64_t time_ns, const std::string& problem);
  // What the last frame came to, with its covariance; until the next one.
  const FrameResult& latest() const { return *latest_; }
  // Recoveries, relocalisations, loops so far: "frame 120: ...".
  const std::vector<std::string>& events() const { return record_.events(); }
  // Lets mapping and places come to their end, after the last frame: map() is final then.
  void settle();
  // Final poses, and the map. Call once, at the end; settles.
  RunResult finish();

 private:
  struct DueUpdate {
    std::int64_t due = 0;  // count of frames processed at which it is taken
    MapUpdate update;
  };
  struct DueCorrection {
    std::int64_t due = 0;  // count of keyframes before which it is applied
    Correction correction;
  };

  void takeDueUpdate(std::int64_t frame_index);
  void takeRecorded(std::int64_t frame_index);
  bool isDue(const DueUpdate& update, std::int64_t frame_index) const;
  void hand(MappingMessage& message);
  bool placesSaw(std::int64_t message) const;
  void applyDueCorrections(std::int64_t keyframes);
  void applyRecordedCorrections(std::int64_t message);
  void remember(std::optional<MapUpdate> update);
  void draw(const cv::Mat& grey, const FrameRecord& record);

  Settings settings_;
  std::optional<RunDecisions> recorded_;
  TrackingWorker tracking_;
  MappingWorker mapping_;
  PlacesWorker places_;
  RunRecord record_;
  const FrameResult* latest_ = nullptr;
  FrameMessages messages_;  // of the current frame
  std::deque<DueUpdate> updates_;
  std::deque<DueCorrection> corrections_;
  std::int64_t processed_ = 0;  // frames
  std::int64_t keyframes_ = 0;  // handed to places
  std::int64_t drawing_interval_ = 100;
};

}  // namespace edgeslam
