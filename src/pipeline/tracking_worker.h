// Tracking at work: frame by frame, with the updates of the map that it is given. Frames, updates and their order
// decide all that it gives.
#pragma once

#include <optional>
#include <vector>

#include "pipeline/frame_result.h"
#include "pipeline/messages.h"
#include "pipeline/settings.h"

namespace edgeslam {

class TrackingWorker {
 public:
  TrackingWorker(const Camera& camera, const Settings& settings)
      : relocalise_(settings.relocalisation_enabled || settings.mapping.recovery_enabled),
        tracker_(camera, settings.tracking) {}

  // Before the first frame: there is a map already, and the camera somewhere in it.
  void goOnWith(const MapView& view, PointId first_free_point) { tracker_.startLost(view, first_free_point); }

  // Between two frames.
  void take(const MapUpdate& update);

  // The next frame, CV_8U of the camera's size; `messages` gets what mapping is to know.
  FrameResult process(std::int64_t index, std::int64_t time_ns, const cv::Mat& grey,
                      std::vector<MappingMessage>& messages);
  // A frame that could not be read.
  FrameResult skip(std::int64_t index, std::int64_t time_ns, const std::string& problem) const;

  // Of the frame processed last; shared and never changed again.
  const cv::Mat& grey() const { return tracker_.latestImages().pyramid.levels[0]; }

  // For drawings.
  const Tracker& tracker() const { return tracker_; }

 private:
  void askWhere(std::int64_t time_ns, MappingMessage& message);

  bool relocalise_ = true;
  Tracker tracker_;
  std::int64_t next_message_ = 0;
  std::int64_t asked_ = -1;             // number of the message with a lost frame that is not answered yet, or -1
  std::int64_t asked_frame_ = -1;       // its frame, or -1 where tracking went on by itself since
  int lost_frames_ = 0;                 // in a row
  std::string not_found_;               // why the last lost frame that was looked for was not found
  std::optional<TrackingState> found_;  // how the frame was found that the next one is tracked from
  std::optional<Pose> last_good_pose_;
  std::int64_t last_good_ns_ = 0;
};

}  // namespace edgeslam
