// Tracking at work: frame by frame, with the updates of the map that it is given. Frames, updates and their order
// decide all that it gives.
#pragma once

#include <optional>
#include <vector>

#include "pipeline/messages.h"
#include "pipeline/settings.h"
#include "tracking/frame_result.h"

namespace edgeslam {

class TrackingWorker {
 public:
  TrackingWorker(const Camera& camera, const Settings& settings);

  // Before the first frame: there is a map already, and the camera somewhere in it.
  void goOnWith(const MapView& view, PointId first_free_point) { tracker_.startLost(view, first_free_point); }

  // Between two frames. What is left in `update` is of no use any more.
  void take(MapUpdate& update);

  // What the inertial unit measured, in order.
  void add(const InertialSample& sample) { tracker_.add(sample); }
  // Where the wheels say that the robot was, likewise.
  void add(const OdometryPose& pose) { tracker_.add(pose); }

  // The next frame, CV_8U of the camera's size; `messages` gets what mapping is to know, nothing where it is
  // `mapping_busy`, so far behind that it can be told nothing. The result holds until the next frame. Once running,
  // without allocation, lock or system call but reading the clock.
  const FrameResult& process(std::int64_t index, std::int64_t time_ns, const cv::Mat& grey, bool mapping_busy,
                             FrameMessages& messages);
  // A frame that could not be read.
  const FrameResult& skip(std::int64_t index, std::int64_t time_ns, const std::string& problem);

  // False while a map is being started.
  bool hasMap() const { return tracker_.view().initialised; }

  // Of the frame processed last; shared and never changed again.
  const std::shared_ptr<const FrameImages>& images() const { return tracker_.latestImages(); }

  // For another thread, after each keyframe: images for the frames to come.
  void prepareImages() {
    tracker_.prepareImages(images_ready);
    tracker_.dropUnusedImages(2 * images_ready);
  }
  // The same where tracking may wait for memory.
  void dropUnusedImages() { tracker_.dropUnusedImages(fewest_images); }

  // For drawings.
  const Tracker& tracker() const { return tracker_; }

 private:
  static constexpr int images_ready = 12;
  static constexpr int fewest_images = 2;

  MappingMessage& nextMessage(FrameMessages& messages);
  bool isToAskWhere(std::int64_t time_ns) const;
  bool isInDoubt() const;
  void askWhere(std::int64_t time_ns, MappingMessage& message);
  static void lookBefore(const ConfirmedPose& doubt, MappingMessage& message);

  bool recovers_ = true;       // lost frames are made keyframes (P21)
  bool is_looked_for_ = true;  // where a frame is lost
  Tracker tracker_;
  FrameResult result_;
  TrackedFrame for_mapping_;
  std::int64_t next_message_ = 0;
  std::int64_t asked_ = -1;             // number of the message with a lost frame that is not answered yet, or -1
  std::int64_t asked_frame_ = -1;       // its frame, or -1 where tracking went on by itself since
  std::int64_t asked_ns_ = 0;           // when the last one was asked
  int lost_frames_ = 0;                 // in a row
  std::string start_reason_;            // why a world that is begun beside others does not stand yet
  std::string not_found_;               // why the last lost frame that was looked for was not found
  std::optional<TrackingState> found_;  // how the frame was found that the next one is tracked from
  std::optional<Pose> last_good_pose_;
  std::int64_t last_good_ns_ = 0;
};

}  // namespace edgeslam
