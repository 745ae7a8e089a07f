// Tracking: every frame its pose, its state, and whether it becomes a keyframe (sections 3.1, 3.2 and 3.4.1 of the
// paper). Exchanges values with mapping: takes map views, gives tracked frames. All memory is taken at the start: on
// the way from a frame to its pose there is no allocation, no lock and no system call but reading the clock (design,
// section 4).
#pragma once

#include <cstddef>
#include <memory>
#include <memory_resource>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "edges/straight_edges.h"
#include "geometry/camera.h"
#include "map/map_view.h"
#include "tracking/followed_frame.h"
#include "tracking/frame_location.h"
#include "tracking/frame_preparation.h"
#include "tracking/frame_result.h"
#include "tracking/keyframe_making.h"
#include "tracking/map_confirmation.h"
#include "tracking/map_reuse.h"
#include "tracking/measured_noise.h"
#include "tracking/spare_start.h"
#include "tracking/stage_times.h"
#include "tracking/tracked_frame.h"
#include "tracking/unseen_motion.h"
#include "tracking/world_uncertainty.h"

namespace edgeslam {

struct TrackerOptions {
  BlurGateOptions blur_gate;
  LocationOptions location;
  MapReuseOptions map_reuse;
  MapConfirmationOptions map_confirmation;
  StraightEdgeOptions straight_edges;
  KeyframeOptions keyframes;
  WorldUncertaintyOptions uncertainty;
  MeasuredNoiseOptions noise;
  int fewest_tracks = 30;      // fewer are not enough to start a map with
  double spare_share = 0.45;   // of the first frame's tracks: fewer left, and another start is kept beside it
  double restart_share = 0.3;  // of the first frame's tracks: fewer left, and the initialisation starts anew ...
  int restart_frames = 4;      // ... after so many such frames: mapping may be about to answer [frames]
  // With fewer of the tracks found in a blurred frame, share of them, the next frame is followed from the one before.
  double blurred_tracks_share = 0.5;
  // Nothing is followed coarsely into a frame with fewer of the edges of the one before, share of them.
  double coarse_fewest_edges = 0.2;
  double regain_seconds = 0.7;          // so long after a loss the last tracked frame's points are still looked for
  std::optional<InertialUnit> inertia;  // that goes with the camera; none: the camera alone
  InertiaOnlyOptions inertia_only;
  std::optional<WheelOptions> wheels;  // beneath the camera; none: the camera alone
  WheelsOnlyOptions wheels_only;
  bool worlds_enabled = true;
  // So long after the first sharp frame that was lost a new world is begun beside those that were lost. Blurred frames
  // do not count: they do not tell that the camera is elsewhere.
  double new_world_seconds = 0.25;
  // Where inertia may tell the pose meanwhile it is begun so long after the first frame without. In a frozen map poses
  // are predicted for so long.
  double predicted_seconds = 1;
  // The map is only localised in: no frame becomes a keyframe, and no points are chosen. Only a run that goes on with a
  // saved map can be so.
  bool map_is_frozen = false;
};

class Tracker {
 public:
  // `edges`, `points`: how they are found in every frame.
  Tracker(const Camera& camera, const EdgeOptions& edges, const PointChoiceOptions& points,
          const TrackerOptions& options);

  // Before the first frame: a map is there already, and the camera somewhere in it, not known where. Frames are lost
  // until one of them is found in it. New points are numbered from `first_free_point` on.
  void startLost(const MapView& view, PointId first_free_point);

  // What the inertial unit measured, in order; before the frames that were taken until then.
  void add(const InertialSample& sample) { motion_.add(sample); }

  // Where the wheels say that the robot was, likewise.
  void add(const OdometryPose& pose) { motion_.add(pose); }

  // `grey`: CV_8U of the camera's size. Frames come in the order of their time stamps. `mapping_busy`: it can be told
  // nothing now, so that this frame becomes no keyframe. `result` is written over. True where mapping is to be told
  // `for_mapping`: this frame, or the one before that became a keyframe late; or where a frozen map is to be shown.
  bool track(std::int64_t frame_index, std::int64_t time_ns, const cv::Mat& grey, bool mapping_busy,
             FrameResult& result, TrackedFrame& for_mapping);

  // An unreadable frame: a pose from motion alone.
  void skip(std::int64_t frame_index, std::int64_t time_ns, const std::string& reason, FrameResult& result) const;

  // Takes over a newer view of the map, between two frames, and leaves the one before in its place.
  void adopt(MapView& view);

  // The last frame where its pose was lost is kept until another one is; gives its images and its tracks without a
  // pose, and the keyframe number that is its if mapping makes it one.
  bool hasLostFrame() const { return frame_is_lost_; }
  void keepLostFrame(TrackedFrame& description);
  // While a world is begun beside others: the latest frame is kept, and described, to be looked for in these.
  bool startsBesideOthers() const { return worlds_ > 0 && !mapStands() && last_.isThere(); }
  std::shared_ptr<const EdgeMap> keptEdges() const { return kept_.edges; }
  // The last pose before the map stopped bearing poses out; empty where it does. The latest frame is kept then, and
  // described, to be looked for in the map as it was.
  const std::optional<ConfirmedPose>& lastBeforeDoubt() const { return confirmation_.lastBeforeDoubt(); }
  void keepLatestFrame(TrackedFrame& description);
  // The kept frame's pose was found after all: tracking goes on from it with the points found, or, where none are
  // given, with the tracks that it had. `view` shows the map around it; the view before is left in its place.
  void resume(MapView& view, const Pose& world_T_camera, const Matrix6d& covariance,
              const std::vector<FoundAgain>& points);

  // Makes images ready for frames to come, in place of those that keyframes keep; for another thread.
  void prepareImages(int count) { preparation_.keepReady(count); }
  void dropUnusedImages(int most) { preparation_.dropUnused(most); }

  // Of the last frame, tracked or not. Valid after the first.
  const std::shared_ptr<const FrameImages>& latestImages() const { return preparation_.latestImages(); }
  // Its edges; null before the first.
  const EdgeMap* latestEdges() const;
  // False where its pose was not found: tracks() are of an earlier one then.
  bool latestIsTracked() const { return last_.isThere() && last_.images == latestImages(); }

  // The last tracked frame, for drawings.
  const std::vector<Track>& tracks() const { return last_.tracks; }
  const MapView& view() const { return view_; }

 private:
  // A frame on its way through track(): when it was taken, whom it may be told to, and where the result goes.
  struct Work {
    std::int64_t time_ns;
    bool mapping_busy;
    FrameResult& result;
    TrackedFrame& for_mapping;
    StageClock clock;
    bool is_blurred = false;  // with a map to follow it in
  };

  bool mapStands() const { return view_.initialised; }

  bool locate(Work& work);
  bool place(Work& work);
  bool goOnByWheels(std::int64_t time_ns);
  void bePlacedByWheels(const Matrix6d& covariance);
  void measureNoise(FrameResult& result);
  bool isToBeginWorld(std::int64_t time_ns) const;
  void beginWorld();
  bool startMap(const char* reason, Work& work);
  bool tooFewAreLeft();
  bool goOnFromSpare();
  bool isToKeepSpare() const;
  void followBlurred(Work& work);
  enum class Following { finely, coarsely };
  bool followCoarsely(Work& work);
  LocationPrior priorFor(const Work& work, Following how) const;
  void helpStart(TrackedFrame& for_mapping);
  bool selectKeyframe(bool& located, Work& work);
  void keepEdgesOfStart(FollowedFrame& frame);
  void becomeKeyframe(FollowedFrame& frame, const char* reason, Work& work);
  bool isToSeeElsewhere(TrackedFrame& for_mapping);
  bool isReuseDue() const;
  void reuseMapWhenDue(Work& work);
  void reuseMap(FollowedFrame& frame);
  void tell(Work& work);
  void tellDoubt(FrameResult& result) const;
  void tellMotion(const Pose& world_T_camera, FrameResult& result) const;
  Matrix6d withSharedNoise(const Matrix6d& covariance) const;
  void remember();
  void predict(std::int64_t time_ns, std::string_view reason, FrameResult& result) const;
  std::optional<WheelPrediction> carriedByWheels(std::int64_t time_ns) const;
  void goOnBy(std::string_view by, FrameResult& result) const;
  void lose(Work& work);
  void keepConfirmation(const MapView& view, bool by_tracks);
  void takeFound(const MapView& view);
  void linkFromLatestKeyframe();
  void beLostSince(std::int64_t time_ns);
  void beFound();
  bool isPredictedStill(std::int64_t time_ns) const;

  Camera calibrated_;
  Camera camera_;  // with what was found of it
  TrackerOptions options_;
  std::size_t most_tracks_;
  FramePreparation preparation_;
  FrameLocation location_;
  KeyframeMaking keyframes_;
  UnseenMotion motion_;
  MeasuredNoise noise_;
  MapConfirmation confirmation_;
  std::unique_ptr<std::byte[]> scratch_memory_;  // as much of it takes room as was ever used
  std::pmr::monotonic_buffer_resource scratch_;  // what one frame needs on the way

  MapView view_;
  FollowedFrame frame_;  // the current one
  FollowedFrame last_;   // the last frame that was located
  LocationFigures figures_;
  std::string lost_reason_;
  FollowedFrame kept_;           // a lost frame that others look for
  KeyframeId kept_number_ = -1;  // that it gets if it is recovered as a keyframe
  bool frame_is_lost_ = false;
  bool is_lost_ = false;                        // the last frame was, and not merely blurred
  std::int64_t lost_since_ns_ = -1;             // or blurred since; -1: neither
  std::int64_t lost_sharp_since_ns_ = -1;       // without the blurred ones; -1: not lost
  bool last_was_found_again_ = false;           // by others, in a frame that may be long past
  int located_in_a_row_ = 0;                    // frames, in a map that stands
  Matrix6d map_covariance_ = Matrix6d::Zero();  // where the last pose was measured
  SpareStart spare_;                            // while the map does not stand
  std::size_t tracks_at_start_ = 0;             // of the first frame of a map that does not stand yet
  int faded_frames_ = 0;                        // in a row, in which too few of these are left
  KeyframeId centre_ = -1;                      // of a frozen map: the view is around it, or was asked for
  int since_reuse_ = 0;                         // frames since points of a frozen map were looked for ...
  std::size_t tracks_at_reuse_ = 0;             // ... and the tracks that there were then; 0: it is due
  int worlds_ = 0;                              // that were tracked in
  int last_world_ = 0;                          // that the last pose was in
};

}  // namespace edgeslam
