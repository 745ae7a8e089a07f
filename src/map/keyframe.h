// What tracking hands to mapping: frames with the measured pixels of their tracks, whole, as values.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "geometry/measurement.h"
#include "geometry/rolling_shutter.h"
#include "geometry/uncertainty.h"
#include "inertia/camera_turns.h"
#include "inertia/preintegration.h"
#include "map/keyframe_images.h"
#include "map/map_line.h"
#include "map/shared_list.h"
#include "wheels/odometry_pose.h"

namespace edgeslam {

using KeyframeId = int;        // counted from 0; culled ones leave gaps
using PointId = std::int64_t;  // of a track, and of the map point that it becomes

// One track as seen in one frame.
struct PointObservation {
  PointId point = 0;
  Measurement measurement;
  Eigen::Vector3d bearing = Eigen::Vector3d::UnitZ();  // unit, of the measurement's pixel, middle row's camera frame
  bool corner = false;
  int chain = -1;          // of the edge on which it was chosen, in the frame where it was chosen
  int order = 0;           // place along that chain
  int straight_edge = -1;  // index of the straight edge of this frame that it lies on; -1: on none, or near its end
};

// How the inertial unit moved since another keyframe.
struct InertialLink {
  KeyframeId from = -1;  // -1: it was not measured all the way
  PreintegratedMotion motion;
  std::int64_t offset_ns = 0;  // of the unit's clock from the camera's, as it was taken to be
};

// What a frame on its way to mapping is there for.
enum class FrameKind {
  first,     // a map is started from it, in place of what there was
  start,     // follows the first frame, while the map does not stand yet
  spare,     // besides, another start may go on from it (tracking/spare_start.h)
  keyframe,  // extends the map
  lost,      // its pose was lost and is looked for
  elsewhere  // the map, which is frozen, is to be shown around another keyframe
};

// A frame on its way to mapping: every frame while there is no map, keyframes and lost frames afterwards.
struct TrackedFrame {
  FrameKind kind = FrameKind::start;
  std::int64_t frame_index = 0;
  std::int64_t time_ns = 0;
  Pose world_T_camera;          // as tracking estimated it; of a lost frame without meaning
  Twist twist = Twist::Zero();  // of the camera as its rows were read
  std::vector<PointObservation> observations;
  std::vector<SeenEdge> straight_edges;       // that at least three of them lie on
  std::shared_ptr<const FrameImages> images;  // null for FrameKind::start
  // Its number; of a lost frame the one that it gets if it is recovered; for FrameKind::elsewhere the keyframe of the
  // map; -1 for FrameKind::start.
  KeyframeId keyframe = -1;
  const char* reason = "";  // which criterion made it a keyframe
  double noise_factor = 1;  // how many times as far as presumed measurements in it err
  int world = 0;            // that its pose is in, or, of a lost frame, that the last pose was in
  std::int64_t start = -1;  // of a frame that helps a start: the first frame that its pose is against
  InertialLink inertia;     // of a keyframe; of a frame that helps a start, since that start's first frame
  OdometryPlace wheels;     // where the wheels say that it is
  // Of a keyframe: what came since the one before, as far as there was room for it. How the camera turned from frame to
  // frame is as it was seen, whatever inertia says.
  std::vector<InertialSample> felt;
  std::vector<CameraTurn> turns;
};

struct Keyframe {
  KeyframeId id = 0;
  int world = 0;  // that its pose is in: counted from 0 (map/worlds.h)
  std::int64_t frame_index = 0;
  std::int64_t time_ns = 0;
  Pose world_T_camera;
  Twist twist = Twist::Zero();                // of the camera as its rows were read
  SharedList<PointObservation> observations;  // sorted by point
  std::vector<SeenEdge> straight_edges;       // that at least three of them lie on
  KeyframeImages images;                      // null for a keyframe that no point is hosted in
  std::string reason;
  Matrix7d uncertainty = Matrix7d::Zero();  // against the world's first keyframe (mapping/map_uncertainty.h)
  InertialLink inertia;                     // from the keyframe before, of the same world
  OdometryPlace wheels;                     // where the wheels say that it is
};

}  // namespace edgeslam
