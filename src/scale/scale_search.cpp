#include "scale/scale_search.h"

#include <cmath>

namespace edgeslam {
namespace {

constexpr double map_interval_s = 2, map_interval_when_known_s = 10;

}  // namespace

ScaleSearch::ScaleSearch(const ScaleOptions& options, const Pose& body_T_camera)
    : options_(options), scale_(options.largest_sigma) {
  if (options.source == "odometry") odometry_.emplace(options.odometry, body_T_camera);
  if (options.source == "camera_height") height_.emplace(options.height);
}

void ScaleSearch::add(const FrameResult& result) {
  if (!odometry_) return;
  const bool found_again = result.state == TrackingState::recovered || result.state == TrackingState::relocalised;
  if (found_again && state_ != result.state) odometry_->breakOff();
  state_ = result.state;
  if (const std::optional<MeasuredPose> measured = measuredPose(result)) odometry_->add(*measured);
}

void ScaleSearch::add(const OdometryPose& pose) {
  if (odometry_) odometry_->add(pose);
}

void ScaleSearch::add(const GroundPlane& ground) {
  if (height_) height_->add(ground);
}

void ScaleSearch::forget() {
  mapWasCorrected();
  scale_.forget();
}

void ScaleSearch::mapWasCorrected() {
  if (odometry_) odometry_->clear();
  if (height_) height_->clear();
}

void ScaleSearch::breakOff() {
  if (odometry_) odometry_->breakOff();
}

std::optional<ScaleEstimate> ScaleSearch::estimate() const {
  if (odometry_) return odometry_->estimate();
  return height_ ? height_->estimate() : std::nullopt;
}

std::optional<ScaleState> ScaleSearch::everySecond() {
  if (odometry_) odometry_->secondPassed();
  if (const std::optional<ScaleEstimate> found = estimate()) {
    scale_.follow(*found, odometry_ ? ScaleKind::odometry : ScaleKind::camera_height);
  }
  if (scale_.scale().kind == ScaleKind::unknown) return std::nullopt;
  return scale_.scale();
}

std::string ScaleSearch::problem() const {
  if (!odometry_ && !height_) return "";
  const std::string waits = odometry_ ? odometry_->problem() : height_->problem();
  if (!waits.empty()) return waits;
  const std::optional<ScaleEstimate> found = estimate();
  if (!found || !found->problem.empty()) return found ? found->problem : "";
  const double sigma = scale_.scale().kind == ScaleKind::unknown ? found->sigma : scale_.scale().sigma;
  if (sigma <= options_.largest_sigma) return "";
  return "it is known to " + std::to_string(std::lround(100 * sigma)) + " % only";
}

bool ScaleSearch::wantsMap(double seconds) const {
  if (!height_) return false;
  const bool known = scale_.scale().kind != ScaleKind::unknown;
  return seconds - last_map_s_ >= (known ? map_interval_when_known_s : map_interval_s);
}

}  // namespace edgeslam
