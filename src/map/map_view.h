// What tracking sees of the map: immutable values with a version number.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geometry/found_camera.h"
#include "inertia/found_time_offset.h"
#include "inertia/found_unit_rotation.h"
#include "inertia/inertial_alignment.h"
#include "map/keyframe_table.h"
#include "wheels/wheel_scale.h"

namespace edgeslam {

struct ViewPoint {
  PointId id = 0;
  KeyframeId host = 0;
  Eigen::Vector3d host_bearing;
  double inverse_depth = 0;
  double inverse_depth_sigma = 0;
  // How the latest keyframe with images saw it: what it is found again by. -1: no such keyframe.
  KeyframeId source = -1;
  Measurement source_measurement;
  bool corner = false;
};

struct ViewKeyframe {
  KeyframeId id = 0;
  Pose world_T_camera;
  std::shared_ptr<const FrameImages> images;  // null where no point needs it
  Matrix7d uncertainty = Matrix7d::Zero();    // against the first keyframe
  Twist twist = Twist::Zero();                // of the camera as its rows were read
};

struct MapView {
  std::uint64_t version = 0;
  int world = 0;                   // all of the view is of one
  std::int64_t origin_frame = -1;  // of the latest start: a view of an attempt that was given up is told by it
  KeyframeId latest_keyframe = 0;  // of all worlds
  KeyframeId centre = -1;          // its points are those around this keyframe; -1 before the map stands
  std::int64_t corrections = 0;    // of the map as a whole: loops, worlds that were joined
  bool initialised = false;        // false: a provisional, flat-depth map from the first frame; poses are not given out
  std::string waiting_for;         // why not, in words that a user understands
  std::optional<InertialAlignment> inertia;    // of the world, where there is an inertial unit
  WheelScale wheels;                           // of the world
  FoundCamera found;                           // of the camera, beside its calibration
  std::optional<FoundTimeOffset> time_offset;  // of the inertial unit's clock, where it is not the one that was given
  std::optional<FoundUnitRotation> unit_rotation;  // likewise, how it is turned against the camera
  bool unit_is_left_out = false;                   // it contradicts the camera, which goes on alone
  KeyframeTable<ViewKeyframe> keyframes;
  std::vector<ViewPoint> points;  // sorted by id
};

inline const ViewPoint* findPoint(const MapView& view, PointId id) {
  const auto found = std::lower_bound(view.points.begin(), view.points.end(), id,
                                      [](const ViewPoint& p, PointId wanted) { return p.id < wanted; });
  return found != view.points.end() && found->id == id ? &*found : nullptr;
}

// Finds points whose numbers ascend from call to call, each from where the last one was.
class AscendingPoints {
 public:
  explicit AscendingPoints(const MapView& view) : at_(view.points.data()), end_(at_ + view.points.size()) {}

  // The point, or null. Never ask for a number below the one before.
  const ViewPoint* find(PointId id) {
    std::ptrdiff_t stride = 1;
    while (stride < end_ - at_ && at_[stride].id < id) {
      at_ += stride;
      stride *= 2;
    }
    at_ = std::lower_bound(at_, at_ + std::min(stride + 1, end_ - at_), id,
                           [](const ViewPoint& point, PointId wanted) { return point.id < wanted; });
    return at_ != end_ && at_->id == id ? at_ : nullptr;
  }

 private:
  const ViewPoint* at_;
  const ViewPoint* end_;
};

inline Eigen::Vector3d worldPosition(const MapView& view, const ViewPoint& point) {
  return view.keyframes[point.host].world_T_camera * (point.host_bearing / point.inverse_depth);
}

// Standard deviation of the inverse depths of a flat start, whose mean is 1: small, since it is their common depth that
// keeps rotation and translation apart where a scene has lines only.
constexpr double flat_start_sigma = 0.05;

// A provisional map: every point of the first frame, whose keyframe number is its role's, at the distance 1 (design,
// section 5: initialisation).
MapView flatView(const TrackedFrame& first);

// Gives a view memory for what tracking adds to it until the next one comes: keyframes, or the points of a new start.
void reserveForTracking(MapView& view);
// Writes flatView(first) into a view that was used before, with its memory.
void makeFlatView(const TrackedFrame& first, MapView& view);

}  // namespace edgeslam
