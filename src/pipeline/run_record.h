// The record of a run, put together from what its frames came to and what mapping and places report.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "adjustment/pose_adjustment.h"
#include "mapping/mapper.h"
#include "pipeline/messages.h"
#include "pipeline/run_result.h"
#include "pipeline/seen_record.h"
#include "tracking/frame_result.h"
#include "visual_odometry/odometry_frame.h"

namespace edgeslam {

class RunRecord {
 public:
  // `pose`: how frames are located anew when the run ends.
  explicit RunRecord(const Camera& camera, const PoseOptions& pose = {}) : pose_(pose) { result_.camera = camera; }

  // Before the first frame: keyframes before `first` are of the run that made a saved map.
  void goOnFrom(KeyframeId first) { first_keyframe_ = first; }
  // In the order of their indices.
  FrameRecord& add(const FrameResult& frame, bool unreadable);
  void add(MappingReport report);
  void add(DrawnFrame drawing) { result_.drawings.push_back(std::move(drawing)); }
  // Until finish().
  const std::vector<std::string>& events() const { return result_.events; }

  // Final poses, and the map. Call once, at the end.
  RunResult finish(const Mapper& mapper);

 private:
  struct CarriedPose {
    KeyframeId reference = -1;  // the keyframe that carries the frame's pose, or -1
    Pose reference_T_camera;    // in the unit of this world
    int world = -1;
  };

  std::size_t placeOf(std::int64_t frame_index) const;
  CarriedPose inWorldOfToday(CarriedPose carried) const;
  void join(const WorldJoin& join);
  void keep(FrameRecord& frame);
  std::optional<WorldPose> finalPose(const Map& map, const CarriedPose& carried) const;
  void giveMap(const Mapper& mapper);
  void giveFinalPose(std::size_t place, const WorldPose& pose);
  int mainWorld() const;

  PoseOptions pose_;
  RunResult result_;
  CameraOdometry odometry_;
  KeyframeId first_keyframe_ = 0;    // of this run
  std::deque<CarriedPose> carried_;  // by frame record
  SeenRecord seen_;                  // by frame record
  bool told_of_seen_ = false;        // that it cannot be kept
  std::map<KeyframeId, CulledKeyframe> culled_;
  std::map<int, WorldJoin> joins_;  // by the younger world
};

}  // namespace edgeslam
