// The lockstep schedule (design, section 4): tracking and mapping exchange values at fixed frames, so that a run is a
// pure function of its input.
#pragma once

#include <deque>
#include <map>
#include <string>

#include "mapping/mapper.h"
#include "pipeline/run_result.h"
#include "pipeline/settings.h"
#include "places/loop_closing.h"
#include "places/relocalisation.h"
#include "tracking/tracker.h"

namespace edgeslam {

class LockstepRun {
 public:
  // `drawings`: about so many frames are drawn for the report, out of `expected_frames` (0: unknown, one every 100).
  LockstepRun(const Camera& camera, const Settings& settings, std::int64_t expected_frames, int drawings);

  // Before the first frame: goes on with a map made earlier, of the same camera. The camera is somewhere in it.
  void goOnWith(Map map);
  // The map as it is now; without keyframes where none stands yet.
  const Map& map() const { return mapper_.map(); }

  // The next frame, CV_8U of the camera's size. Returns its record, without the final pose.
  const FrameRecord& process(std::int64_t index, std::int64_t time_ns, const cv::Mat& grey);
  // A frame that could not be read.
  const FrameRecord& skip(std::int64_t index, std::int64_t time_ns, const std::string& problem);
  // Final poses, carried by their keyframes, and the map. Call once, at the end.
  RunResult finish();

 private:
  struct DueView {
    std::int64_t due = 0;  // count of frames processed at which it is taken
    MapView view;
  };

  void takeDueViews();
  void hand(const std::vector<TrackedFrame>& frames, FrameRecord& record);
  void lookForLoop(FrameRecord& record);
  void findAgain(FrameRecord& record);
  void goOnFrom(FrameRecord& record, TrackingState state, const Pose& world_T_camera, const Matrix6d& covariance,
                KeyframeId centre, const std::vector<FoundAgain>& points);
  void tell(const FrameRecord& record, const std::string& event);
  FrameRecord& record(std::int64_t index, std::int64_t time_ns, const TrackingOutcome& outcome);
  void draw(const cv::Mat& grey, const FrameRecord& record);
  std::optional<Pose> finalPose(KeyframeId reference, Pose reference_T_camera) const;

  Settings settings_;
  Tracker tracker_;
  Mapper mapper_;
  Relocalisation relocalisation_;
  LoopClosing loop_closing_;
  int lost_frames_ = 0;  // in a row
  std::optional<Pose> last_good_pose_;
  std::int64_t last_good_ns_ = 0;
  KeyframeId first_keyframe_ = 0;  // of this run
  RunResult result_;
  std::deque<DueView> views_;
  std::int64_t processed_ = 0;
  std::int64_t drawing_interval_ = 100;
  struct CarriedPose {
    KeyframeId reference = -1;  // the keyframe that carries the frame's pose, or -1
    Pose reference_T_camera;
  };
  std::deque<CarriedPose> carried_;  // by frame record
  std::map<KeyframeId, CulledKeyframe> culled_;
};

}  // namespace edgeslam
