#include "scale/scale_from_odometry.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "files/format_text.h"
#include "wheels/utime.h"

namespace edgeslam {
namespace {

// The two motions of a stretch must be one: so far the camera may be mounted otherwise than is configured, or the
// wheels slip while they turn.
constexpr double turn_allowance_rad = 0.1, turn_allowance_share = 0.1;
constexpr double largest_angle_between_ways_rad = 0.35;
constexpr double largest_motion_sigma = 0.2;  // of the camera's way, as a share of it
constexpr double least_sigma = 0.005;         // of any stretch, as a share
constexpr double least_way_share = 0.3;       // of the camera's way, of the body's: the turn did not undo it

constexpr std::size_t most_stretches = 64;
// The scale of a map is not the same everywhere: standard deviation of its drift after 1 m, grows with the root.
constexpr double drift_per_root_metre = 0.01;
constexpr double longest_stretch_s = 60;
constexpr double longest_gap_s = 0.5;  // between measured poses
constexpr std::size_t most_waiting = 100;

constexpr double largest_clock_error_s = 1;
constexpr int frames_for_another_clock = 15;
constexpr int silence_told_s = 2;
constexpr int refusals_told = 3;

double secondsBetween(const MeasuredPose& before, const MeasuredPose& now) {
  return 1e-9 * static_cast<double>(now.time_ns - before.time_ns);
}

// Variance of the length of the camera's way, over its square.
double motionVariance(const MeasuredPose& before, const MeasuredPose& now, const Pose& moved) {
  const Eigen::Vector3d direction = moved.rotation.conjugate() * moved.translation.normalized();
  const Eigen::Matrix3d covariance =
      (carriedCovariance(before.covariance_camera, moved) + now.covariance_camera).topLeftCorner<3, 3>();
  return std::max(direction.dot(covariance * direction), 0.0) / moved.translation.squaredNorm();
}

}  // namespace

MotionComparison compareMotions(const Pose& before_T_now, const MeasuredPose& before, const MeasuredPose& now,
                                const Pose& body_T_camera, const OdometryOptions& options) {
  constexpr double degree = M_PI / 180;
  const Pose moved = cameraMotion(before, now);
  const Eigen::Quaterniond turn = body_T_camera.rotation * moved.rotation * body_T_camera.rotation.conjugate();
  const double turn_error = rotationAngle(turn, before_T_now.rotation);
  if (!(turn_error <=
        turn_allowance_rad + turn_allowance_share * rotationAngle(turn, Eigen::Quaterniond::Identity()))) {
    return {{}, formatted("the odometry's turn is %.0f degrees off the camera's", turn_error / degree)};
  }
  const Eigen::Vector3d lever = body_T_camera.translation;
  const Eigen::Vector3d way_m = before_T_now.translation - lever + turn * lever;
  const Eigen::Vector3d way = body_T_camera.rotation * moved.translation;
  if (!(way_m.norm() >= least_way_share * before_T_now.translation.norm())) {
    return {{}, "the camera hardly moved where the body turned"};
  }
  const double variance = way.norm() > 0 ? motionVariance(before, now, moved) : HUGE_VAL;
  if (!(variance <= largest_motion_sigma * largest_motion_sigma)) {
    return {{}, "the odometry moves, the camera does not, or its motion is known too badly"};
  }
  const double angle = std::atan2(way.cross(way_m).norm(), way.dot(way_m));
  if (!(angle <= largest_angle_between_ways_rad)) {
    return {{},
            formatted("the odometry's way is %.0f degrees off the camera's (camera.body_T_camera?)", angle / degree)};
  }
  const double slip = options.sigma_per_metre * options.sigma_per_metre * before_T_now.translation.norm();
  ScaleMeasurement measurement;
  measurement.log_scale = std::log(way_m.norm() / way.norm());
  measurement.variance = slip / way_m.squaredNorm() + variance + least_sigma * least_sigma;
  return {measurement, ""};
}

ScaleFromOdometry::ScaleFromOdometry(const OdometryOptions& options, const Pose& body_T_camera)
    : options_(options), body_T_camera_(body_T_camera) {}

void ScaleFromOdometry::add(const OdometryPose& pose) {
  silent_s_ = 0;
  history_.add(pose);
  pair();
}

void ScaleFromOdometry::add(const MeasuredPose& frame) {
  lookAtClock(utimeOf(frame.time_ns));
  waiting_.push_back(frame);
  if (waiting_.size() > most_waiting) waiting_.pop_front();
  pair();
}

// What waits is before the break.
void ScaleFromOdometry::breakOff() {
  waiting_.clear();
  start_.reset();
  last_.reset();
}

void ScaleFromOdometry::clear() {
  breakOff();
  stretches_.clear();
  refused_in_a_row_ = 0;
}

void ScaleFromOdometry::secondPassed() { silent_s_ = std::min(silent_s_ + 1, 1000); }

void ScaleFromOdometry::lookAtClock(std::int64_t frame_utime) {
  const std::optional<std::int64_t> newest = history_.newest();
  if (!newest || silent_s_ > 0) return;
  clock_ahead_s_ = 1e-6 * static_cast<double>(*newest - frame_utime);
  const bool other = !(std::abs(clock_ahead_s_) <= largest_clock_error_s);
  frames_of_another_clock_ = other ? std::min(frames_of_another_clock_ + 1, frames_for_another_clock) : 0;
}

void ScaleFromOdometry::pair() {
  while (!waiting_.empty() && history_.newest() && utimeOf(waiting_.front().time_ns) <= *history_.newest()) {
    const MeasuredPose frame = waiting_.front();
    waiting_.pop_front();
    if (const std::optional<OdometryPlace> body = history_.at(utimeOf(frame.time_ns))) advance({frame, *body});
  }
}

void ScaleFromOdometry::advance(const Paired& paired) {
  const auto goesOn = [&] {
    return start_ && last_ && paired.body.piece == start_->body.piece && paired.frame.time_ns > last_->frame.time_ns &&
           secondsBetween(last_->frame, paired.frame) <= longest_gap_s &&
           secondsBetween(start_->frame, paired.frame) <= longest_stretch_s;
  };
  if (!goesOn()) start_ = paired;
  last_ = paired;
  const Pose before_T_now = start_->body.local_T_body.inverse() * paired.body.local_T_body;
  if (before_T_now.translation.norm() < options_.window_m) return;
  const MotionComparison comparison =
      compareMotions(before_T_now, start_->frame, paired.frame, body_T_camera_, options_);
  start_ = paired;
  if (!comparison.problem.empty()) {
    refused_ = comparison.problem;
    refused_in_a_row_ = std::min(refused_in_a_row_ + 1, refusals_told);
    return;
  }
  refused_in_a_row_ = 0;
  for (ScaleMeasurement& earlier : stretches_) {
    earlier.variance += drift_per_root_metre * drift_per_root_metre * before_T_now.translation.norm();
  }
  stretches_.push_back(comparison.measurement);
  if (stretches_.size() > most_stretches) stretches_.pop_front();
}

std::optional<ScaleEstimate> ScaleFromOdometry::estimate() const {
  return scaleEstimate({stretches_.begin(), stretches_.end()}, fewest_stretches, options_.sigma, true);
}

std::string ScaleFromOdometry::problem() const {
  if (silent_s_ >= silence_told_s) return "no odometry on " + options_.channel;
  if (frames_of_another_clock_ >= frames_for_another_clock) {
    return formatted("the odometry's time stamps are %.6g s ahead of the camera's: both must be CLOCK_MONOTONIC",
                     clock_ahead_s_);
  }
  if (refused_in_a_row_ >= refusals_told) return refused_;
  if (stretches_.size() < fewest_stretches) {
    return std::to_string(stretches_.size()) + " of " + std::to_string(fewest_stretches) + " stretches of " +
           formatted("%.3g m driven", options_.window_m);
  }
  return "";
}

}  // namespace edgeslam
