#include "mapping/wheel_scale_estimate.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "files/format_text.h"
#include "geometry/scale_estimate.h"
#include "geometry/squared.h"

namespace edgeslam {
namespace {

constexpr double largest_angle_between_ways = 0.35;  // [rad]: else they are not of one motion
constexpr double turn_allowance = 0.1;               // likewise, [rad] and share of the turn
constexpr double camera_sigma = 0.02;                // of the camera's way, as a share: keyframes bend
constexpr double least_camera_sigma = 0.002;         // likewise, a share of the scene's distance, which is about 1

struct Stretches {
  std::vector<ScaleMeasurement> measurements;
  int contradicted = 0;
};

void compare(const Keyframe& first, const Keyframe& last, const WheelMotion& motion, Stretches& stretches) {
  const Pose moved = first.world_T_camera.inverse() * last.world_T_camera;
  const Eigen::Vector3d &way_m = motion.first_T_second.translation, &way = moved.translation;
  const double turn = rotationAngle(motion.first_T_second.rotation, Eigen::Quaterniond::Identity());
  const double angle = std::atan2(way.cross(way_m).norm(), way.dot(way_m));
  const bool is_one_motion =
      rotationAngle(motion.first_T_second.rotation, moved.rotation) <= turn_allowance * (1 + turn) &&
      angle <= largest_angle_between_ways;
  if (!is_one_motion || !(way.norm() > 0)) {
    ++stretches.contradicted;
    return;
  }
  const Eigen::Vector3d direction = motion.first_T_second.rotation.conjugate() * way_m.normalized();
  const double variance_m = direction.dot(motion.covariance.topLeftCorner<3, 3>() * direction);
  stretches.measurements.push_back(
      {std::log(way_m.norm() / way.norm()),
       variance_m / way_m.squaredNorm() + squared(camera_sigma) + squared(least_camera_sigma) / way.squaredNorm()});
}

Stretches stretchesOf(const WheelOptions& wheels, double stretch_m, const Map& map, int world) {
  Stretches stretches;
  const Keyframe* first = nullptr;
  for (const Keyframe& keyframe : map.keyframes) {
    if (keyframe.world != world) continue;
    const std::optional<WheelMotion> motion =
        first ? wheelMotion(wheels, first->wheels, keyframe.wheels) : std::nullopt;
    if (!motion) {
      first = &keyframe;
    } else if (motion->first_T_second.translation.norm() >= stretch_m) {
      compare(*first, keyframe, *motion, stretches);
      first = &keyframe;
    }
  }
  return stretches;
}

}  // namespace

WheelScaleEstimate estimateWheelScale(const WheelOptions& wheels, const WheelScaleOptions& options, const Map& map,
                                      int world) {
  const Stretches stretches = stretchesOf(wheels, options.stretch_m, map, world);
  const auto agreeing = static_cast<int>(stretches.measurements.size());
  WheelScaleEstimate estimate;
  if (stretches.contradicted > agreeing && stretches.contradicted >= options.fewest_stretches) {
    estimate.lacking = "wheels: they contradict the camera's motion; is camera.body_T_camera right?";
    return estimate;
  }
  const std::optional<ScaleEstimate> found = scaleEstimate(
      stretches.measurements, static_cast<std::size_t>(options.fewest_stretches), options.shared_sigma, true);
  if (!found) {
    estimate.lacking = formatted("wheels: %d of %d stretches of %.2f m driven that tell the scale", agreeing,
                                 options.fewest_stretches, options.stretch_m);
  } else if (!found->problem.empty()) {
    estimate.lacking = "wheels: " + found->problem;
  } else if (!(found->sigma <= options.largest_sigma)) {
    estimate.lacking = formatted("wheels: the scale is known to %.0f %% only", 100 * found->sigma);
  } else {
    estimate.scale = {true, std::exp(found->log_scale), found->sigma};
  }
  return estimate;
}

}  // namespace edgeslam
