// Tracking: every frame its pose, its state, and whether it becomes a keyframe (sections 3.1, 3.2 and 3.4.1 of the
// paper). Exchanges values with mapping: takes map views, gives tracked frames. All memory is taken at the start: on
// the way from a frame to its pose there is no allocation, no lock and no system call but reading the clock (design,
// section 4).
#pragma once

#include <memory_resource>
#include <string>
#include <string_view>
#include <vector>

#include "edges/blur_gate.h"
#include "edges/point_choice.h"
#include "flow/optical_flow.h"
#include "geometry/camera.h"
#include "map/map_view.h"
#include "tracking/edge_lock.h"
#include "tracking/keyframe_selection.h"
#include "tracking/map_reuse.h"
#include "tracking/patch_refinement.h"
#include "tracking/pose_estimation.h"
#include "tracking/recycling_pool.h"
#include "tracking/rotation_alignment.h"
#include "tracking/sparse_alignment.h"
#include "tracking/stage_times.h"

namespace edgeslam {

struct TrackerOptions {
  EdgeOptions edges;
  BlurGateOptions blur_gate;
  PointChoiceOptions points;
  FlowOptions flow;
  FramePoseOptions pose;
  RefinementOptions refinement;
  EdgeLockOptions edge_lock;
  SparseAlignmentOptions alignment;
  MapReuseOptions map_reuse;
  KeyframeOptions keyframes;
  int fewest_tracks = 30;      // fewer are not enough to start a map with
  double restart_share = 0.3;  // of the first frame's tracks: fewer left, and the initialisation starts anew
  int outlier_frames = 4;      // a track whose map point misses the pose so often in a row is dropped
  // The first pose after a loss or blur needs a good part of the points that the last good pose had ...
  double regain_points_share = 0.7;
  // ... or fewer of them, where these are most of the map points in view.
  double regain_fewest_points_share = 0.3;
  double regain_inlier_share = 0.6;
  double regain_seconds = 0.7;       // so long after a loss the last tracked frame's points are still looked for
  double least_inlier_share = 0.35;  // of the map points in view: fewer, and the pose is not believed ...
  double least_points_share = 0.15;  // ... nor with fewer than this share of the points of the pose before ...
  double largest_deviation = 0.03;   // ... nor where it is less certain: share of the scene's depth, or angle [rad]
  // Errors of the map's points and of neighbours on an edge go together: the pose's standard deviations in the world
  // are so many times what independent measurements would give.
  double correlation_factor = 6;
  // Map points that contradict the pose go together, too (something that moves, a torn image): this share of those in
  // view doubles the pose's variance in the world, twice the share makes it five times as large.
  double doubling_outlier_share = 0.2;
  double calibration_sigma = 0.5;  // of directions, whatever is seen: no calibration is quite right [px]
};

enum class FrameState { initialising, tracking, predicted, lost };

struct TrackingOutcome {
  FrameState state = FrameState::initialising;
  std::string reason;                      // why the state is not `tracking`
  Pose world_T_camera;                     // measured when tracking, from motion alone when predicted
  Matrix6d covariance = Matrix6d::Zero();  // of the right-hand update [translation; rotation], in the map as it is
  Matrix6d world_covariance = Matrix6d::Zero();  // with the map's own uncertainty where the camera looks
  KeyframeId reference = -1;                     // the keyframe that carries this frame's final pose, or -1
  Pose reference_T_camera;
  int tracked_points = 0;
  int mapped_points = 0;  // map points that agree with the pose
  bool tells_mapping = false;
  TrackedFrame for_mapping;  // this frame, or the one before that became a keyframe late
  StageTimes times;
};

// A map point found again in a frame whose pose was lost.
struct FoundAgain {
  PointId point = 0;
  Measurement measurement;
  bool corner = false;
};

class Tracker {
 public:
  Tracker(const Camera& camera, const TrackerOptions& options);

  // Before the first frame: a map is there already, and the camera somewhere in it, not known where. Frames are lost
  // until one of them is found in it. New points are numbered from `first_free_point` on.
  void startLost(const MapView& view, PointId first_free_point);

  // Takes over a newer view of the map, between two frames, and leaves the one before in its place.
  void adopt(MapView& view);

  // `grey`: CV_8U of the camera's size. Frames come in the order of their time stamps. `mapping_busy`: it can be told
  // nothing now, so that this frame becomes no keyframe. `outcome` is written over.
  void track(std::int64_t frame_index, std::int64_t time_ns, const cv::Mat& grey, bool mapping_busy,
             TrackingOutcome& outcome);

  // An unreadable frame: a pose from motion alone.
  void skip(std::int64_t time_ns, const std::string& reason, TrackingOutcome& outcome) const;

  // Makes images ready for frames to come, in place of those that keyframes keep; for another thread.
  void prepareImages(int count) { image_pool_.keepReady(count); }

  // The last frame where its pose was lost is kept until another one is; gives its images and its tracks without a
  // pose, and the keyframe number that is its if mapping makes it one.
  bool hasLostFrame() const { return lost_.images != nullptr; }
  void keepLostFrame(TrackedFrame& description);
  std::shared_ptr<const EdgeMap> keptEdges() const { return kept_.edges; }
  // The kept frame's pose was found after all: tracking goes on from it with the points found, or, where none are
  // given, with the tracks that it had. `view` shows the map around it; the view before is
  // left in its place.
  void resume(MapView& view, const Pose& world_T_camera, const Matrix6d& covariance,
              const std::vector<FoundAgain>& points);

  // Of the last frame, tracked or not. Valid after the first.
  const std::shared_ptr<const FrameImages>& latestImages() const { return latest_images_; }
  // Its edges; null before the first.
  const EdgeMap* latestEdges() const;
  // False where its pose was not found: tracks() are of an earlier one then.
  bool latestIsTracked() const { return last_.images && last_.images == latest_images_; }

  // The last tracked frame, for drawings.
  const std::vector<Track>& tracks() const { return last_.tracks; }
  const MapView& view() const { return view_; }

 private:
  struct TrackedState {
    std::shared_ptr<const FrameImages> images;  // null before the first frame
    std::shared_ptr<EdgeMap> edges;
    std::vector<Track> tracks;  // ascending ids
    Pose world_T_camera;
    Matrix6d covariance = Matrix6d::Zero();
    int inlier_count = 0;
    double outlier_share = 0;  // of the map points in view
  };

  void takeMemory();
  void prepare(std::int64_t frame_index, std::int64_t time_ns, const cv::Mat& grey, StageClock& clock);
  bool isLost(std::int64_t time_ns) const;
  bool followAndLocate(StageClock& clock);
  Pose alignImages(const AlignmentPoints& points);
  int fewestInliers(std::size_t in_view) const;
  void dropOutliers(const FramePose& estimate);
  void reuseMap(TrackedState& frame);
  void report(bool mapping_busy, TrackingOutcome& outcome);
  Matrix6d uncertaintyOfMapAt(const TrackedState& state);
  Matrix6d inWorld(const Matrix6d& covariance, double outlier_share) const;
  void predict(std::int64_t time_ns, std::string_view reason, TrackingOutcome& outcome) const;
  void lose(std::int64_t time_ns, const char* reason, TrackingOutcome& outcome);
  Pose predictPose(std::int64_t time_ns) const;
  void remember();

  void startMap(const char* reason, bool mapping_busy, StageClock& clock, TrackingOutcome& outcome);
  KeyframeDecision judge() const;
  void becomeKeyframe(TrackedState& frame, const char* reason, TrackingOutcome& outcome);
  void choosePointsIn(TrackedState& frame, KeyframeId keyframe);
  void describe(const TrackedState& frame, KeyframeId keyframe, const char* reason, TrackedFrame& description) const;
  void askForKeyframe();

  Camera camera_;
  TrackerOptions options_;
  std::vector<RotationGrid> rotation_grids_;
  RecyclingPool<FrameImages> image_pool_;
  RecyclingPool<EdgeMap> edge_pool_;
  EdgeWorkspace edge_workspace_;
  PointChoiceWorkspace choice_workspace_;
  PointChoiceOptions points_;  // with the latest image's noise
  std::vector<Eigen::Vector2f> occupied_;
  std::vector<ChosenPoint> chosen_;
  std::vector<std::byte> scratch_memory_;
  std::pmr::monotonic_buffer_resource scratch_;  // what one frame needs on the way
  MapView view_;
  BlurGate blur_gate_;
  std::shared_ptr<const FrameImages> latest_images_;
  TrackedState frame_;                          // the current one
  TrackedState lost_;                           // the current one where its pose was not found
  TrackedState kept_;                           // a lost frame that others look for
  Matrix6d map_covariance_ = Matrix6d::Zero();  // where the last pose was measured
  std::int64_t lost_since_ns_ = -1;             // -1: not lost
  TrackedState last_;                           // the last frame that was tracked
  Pose last_T_next_;              // motion from the last tracked frame to the next, one frame interval ahead
  std::int64_t interval_ns_ = 0;  // that the motion was measured over
  PointId next_point_ = 0;
  KeyframeId next_keyframe_ = 0;
  std::size_t tracks_at_start_ = 0;
  std::int64_t keyframe_time_ns_ = 0;
  int frames_since_keyframe_ = 0;
  int mapped_at_keyframe_ = 0;
  double average_tracks_ = 0;
};

}  // namespace edgeslam
