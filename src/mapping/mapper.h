// Mapping: every keyframe (section 3.4 of the paper). Owns the map; takes tracked frames, gives map views.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "map/map_change.h"
#include "mapping/camera_finding.h"
#include "mapping/culling.h"
#include "mapping/global_adjustment.h"
#include "mapping/inertial_alignment_estimate.h"
#include "mapping/initialisation.h"
#include "mapping/local_adjustment.h"
#include "mapping/loose_unit_check.h"
#include "mapping/map_uncertainty.h"
#include "mapping/new_points.h"
#include "mapping/time_offset_finding.h"
#include "mapping/track_loss_recovery.h"
#include "mapping/unit_rotation_finding.h"
#include "mapping/view_of_map.h"
#include "mapping/wheel_scale_estimate.h"

namespace edgeslam {

struct MapperOptions {
  InitialisationOptions initialisation;
  NewPointOptions new_points;
  LocalAdjustmentOptions local_adjustment;
  CullingOptions culling;
  GlobalAdjustmentOptions global_adjustment;
  bool recovery_enabled = true;
  RecoveryOptions recovery;
  ViewOptions view;
  MapUncertaintyOptions uncertainty;
  InertialAlignmentOptions inertial_alignment;  // with local_adjustment.inertia
  WheelScaleOptions wheel_scale;                // with local_adjustment.wheels
  CameraFindingOptions camera_finding;
  int alignment_interval = 8;  // keyframes from one adjustment together with scale and gravity to another ...
  double well_known_scale_sigma = 0.005;  // ... until the scale's standard deviation is this share of it
};

struct WorldPose {
  int world = 0;
  Pose world_T_camera;
  Twist twist = Twist::Zero();
};

// Of a frame before its map stood: in its world.
struct EarlyPose {
  std::int64_t frame_index = 0;
  int world = 0;
  Pose world_T_camera;
};

class Mapper {
 public:
  Mapper(const Camera& camera, const MapperOptions& options)
      : calibrated_(camera),
        camera_(camera),
        options_(options),
        initialisation_(camera, options.initialisation),
        camera_finding_(options.camera_finding) {
    if (!options.local_adjustment.inertia) return;
    time_offset_finding_.emplace(*options.local_adjustment.inertia);
    unit_rotation_finding_.emplace(*options.local_adjustment.inertia);
    loose_unit_check_.emplace();
  }

  // Before the first frame: continues a map made earlier, of the same camera.
  void goOnWith(Map map);

  // Takes over a frame. True where the map, or what it waits for, changed. The first frame of a start begins a world
  // beside those there are; one that tracking never followed, as it began anew meanwhile, is forgotten. So does the
  // first that is against a spare start's frame: the start goes on with what was seen since.
  bool add(const TrackedFrame& frame);

  // P21: the lost frame's tracks, all without pose, and the last two keyframes. Where it is found the frame becomes a
  // keyframe and its tracks map points; `view()` then shows it.
  RecoveryResult recover(const TrackedFrame& lost);
  // Tracking is in this keyframe's world again; a start that was under way is given up.
  void goBackTo(KeyframeId keyframe);
  // What was done to a copy of the map as a whole (P20, P27).
  void apply(const MapChange& change);
  // Keyframes taken out of the map since this was last asked, in that order.
  std::vector<CulledKeyframe> takeCulled() { return std::exchange(culled_, {}); }
  // The world that tracking is in as tracking gets to see it; `centre` -1: around its latest keyframe.
  MapView view(KeyframeId centre = -1) const;

  // The world that tracking is in stands.
  bool initialised() const { return initialised_; }
  // Worlds that came to stand too late for tracking.
  std::size_t startsGivenUp() const { return starts_given_up_; }
  // That tracking is in, or was in before the start that is under way; -1 before the first one stood.
  int world() const { return world_; }
  // All worlds that stand; empty before the first one does.
  const Map& map() const { return map_; }
  // How the first world came to be, in words, and the latest.
  const std::string& initialisationDescription() const { return first_description_; }
  const std::string& latestDescription() const { return description_; }
  // Where a pose is now that the world it was in may be part of another.
  WorldPose inWorldOfToday(WorldPose pose) const;
  // How the world that tracking is in lies to the earth; null where that is not known.
  const InertialAlignment* knownAlignment() const;
  // How many metres a unit of it is, by the wheels; null where that is not known.
  const WheelScale* knownWheelScale() const;
  // Why not; empty where it is, or there are no wheels.
  const std::string& lackingForWheels() const { return lacking_for_wheels_; }
  // What is amiss between the camera and the wheels; or empty.
  std::string contradictionOfWheels() const;
  // Why it is not known how the world lies to the earth; empty where it is, or there is no inertial unit.
  const std::string& lackingForInertia() const { return lacking_; }
  // The camera with what was found of it, and what stays so.
  const Camera& camera() const { return camera_; }
  const CameraFinding& cameraFinding() const { return camera_finding_; }
  // How the clocks of the unit and the camera differ, where that is not as it was given; also where it comes too late.
  std::optional<FoundTimeOffset> foundTimeOffset() const {
    return time_offset_finding_ ? time_offset_finding_->found() : std::nullopt;
  }
  // How the unit is turned against the camera, likewise.
  const std::optional<FoundUnitRotation>& foundUnitRotation() const { return map_.unit_rotation; }
  // By how much it seems to be turned otherwise than is given, where that is too far to be used [rad]; else 0.
  double unitRotationTooFar() const { return unit_rotation_finding_ ? unit_rotation_finding_->tooFar() : 0; }
  // What was seen of a unit that is loose; null: nothing.
  const LooseUnitCheck* looseUnit() const {
    return loose_unit_check_ && loose_unit_check_->isLoose() ? &*loose_unit_check_ : nullptr;
  }
  // Poses of the frames before their maps stood, with the worlds as they are now.
  std::vector<EarlyPose> earlyPoses() const;

 private:
  // The frames before a world stood.
  struct Start {
    int world = -1;
    KeyframeId origin = -1;                            // the world's first keyframe
    double scale = 1;                                  // of lengths since
    std::vector<std::pair<std::int64_t, Pose>> poses;  // origin_T_camera
  };

  void start(InitialFrames frames);
  void keepForSpare(const TrackedFrame& frame);
  bool goOnStarting(const TrackedFrame& frame);
  void stand();
  void makeRoomFor(KeyframeId keyframe);
  bool addKeyframe(const TrackedFrame& frame);
  void findCamera();
  void takeCamera(const Camera& camera);
  void findTimeOffset(const TrackedFrame& keyframe);
  InertialUnit unitAsFound() const;
  void findUnitRotation();
  void checkUnit();
  void leaveUnitOut(const char* why, std::int64_t wrong_since_ns);
  void alignAnew();
  void alignToEarth();
  void scaleByWheels();
  void alignWithMap(const InertialAlignment& start);

  Camera calibrated_;
  Camera camera_;  // with what was found of it
  MapperOptions options_;
  Initialisation initialisation_;
  CameraFinding camera_finding_;
  std::optional<TimeOffsetFinding> time_offset_finding_;      // where there is an inertial unit
  std::optional<UnitRotationFinding> unit_rotation_finding_;  // likewise
  std::optional<LooseUnitCheck> loose_unit_check_;            // likewise
  std::int64_t metric_since_ns_ = 0;                          // when it was last found how a world lies to the earth
  Map map_;
  Candidates candidates_;
  std::string first_description_, description_;
  std::string lacking_;
  std::string lacking_for_wheels_;
  int keyframes_since_alignment_ = 0;
  bool initialised_ = false;
  bool start_stood_ = false;  // the latest one
  int world_ = -1;
  int next_world_ = 0;
  std::size_t starts_given_up_ = 0;
  std::uint64_t version_ = 0;
  std::int64_t corrections_ = 0;        // of the map as a whole
  std::int64_t origin_frame_ = -1;      // of the latest start
  std::optional<InitialFrames> spare_;  // another start that it may go on from
  std::vector<CulledKeyframe> culled_;
  std::vector<Start> starts_;       // of the worlds that stand
  std::map<int, WorldJoin> joins_;  // by the younger world
};

}  // namespace edgeslam
