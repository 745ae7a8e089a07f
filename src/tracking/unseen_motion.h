// Where the camera is while the map does not tell it: as it moved on, by inertia, by the wheels, or by both: then it is
// turned as the gyroscope says, and where the wheels say. And whether that is known so well that it is as good as a
// measured pose.
#pragma once

#include <cstdint>
#include <optional>

#include "map/map_view.h"
#include "tracking/followed_frame.h"
#include "tracking/inertial_motion.h"
#include "tracking/motion_by_wheels.h"
#include "tracking/motion_model.h"

namespace edgeslam {

// Frames that show nothing of the map get their poses from inertia for as long as these are known so well.
struct InertiaOnlyOptions {
  double longest_s = 2;                      // since a frame was located
  double largest_position_deviation = 0.1;   // standard deviation, share of the scene's distance
  double largest_rotation_deviation = 0.05;  // [rad]
};

// Likewise by wheels, and frames in which none of the map is found.
struct WheelsOnlyOptions {
  double longest_s = 20;                     // since a frame was located
  double largest_position_deviation = 0.3;   // standard deviation, share of the scene's distance
  double largest_rotation_deviation = 0.12;  // [rad]
  // A frame with so many of the edges that the last one had, share of them, shows that wheels which stood are wrong.
  double contradicting_edges = 0.5;
  // With fewer edges than so many of the last one's, share of them, a frame shows nothing to go on from.
  double fewest_edges = 0.2;
};

// `last` below is the last frame with a pose.
class UnseenMotion {
 public:
  UnseenMotion(const std::optional<InertialUnit>& unit, const InertiaOnlyOptions& inertia_only,
               const std::optional<WheelOptions>& wheels, const WheelsOnlyOptions& wheels_only)
      : inertia_only_(inertia_only), wheels_only_(wheels_only), has_wheels_(wheels), inertia_(unit), wheels_(wheels) {}

  // What was measured, in order; before the frames that were taken until then.
  void add(const InertialSample& sample) { inertia_.add(sample); }
  void add(const OdometryPose& pose) { wheels_.add(pose); }

  // Of no piece where the wheels do not tell it.
  OdometryPlace wheelsAt(std::int64_t time_ns) const { return wheels_.at(time_ns); }
  // For the links between keyframes.
  InertialMotion& inertia() { return inertia_; }
  bool hasInertia() const { return inertia_.isThere(); }

  // Every frame that has a pose, after `last`; `sigma`: standard deviation of its place [map units].
  void observe(const FollowedFrame& last, const FollowedFrame& now, double sigma, const MapView& view);
  // Only how the camera moves, of a frame that is known coarsely: nothing is measured by it.
  void observeCoarsely(const FollowedFrame& last, const FollowedFrame& now);
  // What was observed does not go together with what comes: all of it, or how the wheels agree with it.
  void forget();
  void forgetWheels() { wheels_.forget(); }
  // The same, and `last` was found by other means.
  void goOnFrom(const FollowedFrame& last);
  // Lengths are so many times what they were.
  void scale(double factor);

  // By the wheels or inertia where these were measured, else as the camera moved on.
  InertialPrediction predict(const FollowedFrame& last, std::int64_t time_ns, const MapView& view) const;
  RowMotion whileRowsAreRead(const FollowedFrame& last, std::int64_t time_ns, bool map_stands) const;

  bool isKnownByInertia(const InertialPrediction& prediction, const FollowedFrame& last, std::int64_t time_ns) const;
  // None where the wheels do not tell it, not well enough, or `frame`, where it is of that time, contradicts them.
  std::optional<WheelPrediction> carriedByWheels(const FollowedFrame& last, const FollowedFrame& frame,
                                                 std::int64_t time_ns, const MapView& view) const;

 private:
  InertialPrediction byCamera(const FollowedFrame& last, std::int64_t time_ns) const;
  std::optional<WheelPrediction> byWheels(const FollowedFrame& last, std::int64_t time_ns, const MapView& view) const;
  bool turnByGyroscope(const FollowedFrame& last, std::int64_t time_ns, const MapView& view,
                       WheelPrediction& prediction) const;

  InertiaOnlyOptions inertia_only_;
  WheelsOnlyOptions wheels_only_;
  bool has_wheels_;
  MotionModel motion_;
  InertialMotion inertia_;
  MotionByWheels wheels_;
  // Of the last frame that the camera, and not the wheels, located.
  OdometryPlace located_place_;
  Matrix6d located_covariance_ = Matrix6d::Zero();
  std::int64_t located_ns_ = 0;
};

}  // namespace edgeslam
