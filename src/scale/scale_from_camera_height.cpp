#include "scale/scale_from_camera_height.h"

#include <cmath>

namespace edgeslam {
namespace {

// The scale of a map is not the same everywhere: standard deviation of its drift from look to look.
constexpr double drift_per_look = 0.01;
// What is near the ground and not on it (skirting boards, thresholds) moves the plane: so much in simulated corridors.
constexpr double plane_sigma = 0.02;

}  // namespace

GroundPlane groundOf(const Map& map, const Pose& body_T_camera, const CameraHeightOptions& options) {
  GroundOptions ground;
  ground.largest_tilt_deg = options.largest_tilt_deg;
  const Eigen::Vector3d camera_up = body_T_camera.rotation.conjugate() * Eigen::Vector3d::UnitZ();
  return findGround(groundScene(map, camera_up, ground), ground);
}

void ScaleFromCameraHeight::add(const GroundPlane& ground) {
  refused_ = ground.problem;
  for (ScaleMeasurement& earlier : looks_) earlier.variance += drift_per_look * drift_per_look;
  if (!ground.problem.empty() || !(ground.height > 0) || !(ground.sigma > 0)) {
    if (!looks_.empty()) looks_.pop_front();  // so that what is seen now and then by chance does not add up
    return;
  }
  looks_.push_back({std::log(options_.camera_height_m / ground.height), ground.sigma * ground.sigma});
  if (looks_.size() > most_looks) looks_.pop_front();
}

void ScaleFromCameraHeight::clear() {
  looks_.clear();
  refused_ = "no ground looked for yet";
}

std::optional<ScaleEstimate> ScaleFromCameraHeight::estimate() const {
  const double shared_sigma = std::hypot(options_.sigma_m / options_.camera_height_m, plane_sigma);
  return scaleEstimate({looks_.begin(), looks_.end()}, fewest_looks, shared_sigma, false);
}

std::string ScaleFromCameraHeight::problem() const {
  if (!refused_.empty() || looks_.size() >= fewest_looks) return refused_;
  return "the ground was seen " + std::to_string(looks_.size()) + " of " + std::to_string(fewest_looks) + " times";
}

}  // namespace edgeslam
