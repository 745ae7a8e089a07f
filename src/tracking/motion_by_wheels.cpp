#include "tracking/motion_by_wheels.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "geometry/squared.h"
#include "geometry/uncertainty.h"
#include "wheels/utime.h"

namespace edgeslam {
namespace {

constexpr double longest_gap_s = 1;  // between two poses of the wheels
// Over which camera and wheels are compared.
constexpr double shortest_compared_s = 0.4, longest_compared_s = 1.5;
constexpr double contradiction = 5;                                     // of the whitened difference's length
constexpr int contradictions_to_doubt = 3, agreements_to_believe = 10;  // frames in a row
// How well the camera is known to move, whatever the covariances say: points in a map err alike.
constexpr double camera_times = 6;
constexpr double camera_turn_sigma = 0.01;  // [rad]
constexpr double camera_way_sigma = 0.015;  // [m] ...
constexpr double camera_way_share = 0.1;    // ... and share of the way
// Wheels that move less stand.
constexpr double standing_way_m = 2e-3, standing_turn_rad = 5e-3;
constexpr std::int64_t pieces_between_doubts = std::int64_t{1} << 32;

}  // namespace

MotionByWheels::MotionByWheels(const std::optional<WheelOptions>& wheels) : wheels_(wheels) {
  if (wheels) history_.emplace(longest_gap_s);
}

void MotionByWheels::add(const OdometryPose& pose) {
  if (history_) history_->add(pose);
}

std::optional<OdometryPlace> MotionByWheels::measuredAt(std::int64_t time_ns) const {
  return history_ ? history_->atOrSoonAfter(utimeOf(time_ns)) : std::nullopt;
}

// Places before and after the wheels were doubted are of two pieces.
OdometryPlace MotionByWheels::at(std::int64_t time_ns) const {
  const std::optional<OdometryPlace> measured = are_believed_ ? measuredAt(time_ns) : std::nullopt;
  if (!measured) return {};
  OdometryPlace place = *measured;
  place.piece += times_doubted_ * pieces_between_doubts;
  return place;
}

bool MotionByWheels::contradicts(const Located& before, const Located& now, const WheelScale& scale) const {
  const std::optional<WheelMotion> wheels = wheelMotion(*wheels_, before.place, now.place);
  if (!wheels) return false;
  const Pose moved = before.camera.world_T_camera.inverse() * now.camera.world_T_camera;
  const Matrix6d of_camera = squared(camera_times) * (carriedCovariance(before.covariance, moved) + now.covariance);
  const auto isFar = [](const Eigen::Vector3d& error, const Eigen::Matrix3d& covariance) {
    const Eigen::LLT<Eigen::Matrix3d> factor(covariance);
    return factor.info() == Eigen::Success && error.dot(factor.solve(error)) > squared(contradiction);
  };
  Eigen::Matrix3d covariance = wheels->covariance.bottomRightCorner<3, 3>() + of_camera.bottomRightCorner<3, 3>();
  covariance.diagonal().array() += squared(camera_turn_sigma);
  const Eigen::Quaterniond turn_error = wheels->first_T_second.rotation.conjugate() * moved.rotation;
  if (isFar(rotationLog(turn_error.normalized()), covariance)) return true;
  if (!scale.is_known) return false;
  covariance =
      wheels->covariance.topLeftCorner<3, 3>() + squared(scale.metres_a_unit) * of_camera.topLeftCorner<3, 3>();
  const double way = scale.metres_a_unit * moved.translation.norm();
  covariance.diagonal().array() += squared(camera_way_sigma) + squared(camera_way_share * way);
  const Eigen::Vector3d way_error =
      moved.rotation.conjugate() * (scale.metres_a_unit * moved.translation - wheels->first_T_second.translation);
  return isFar(way_error, covariance);
}

void MotionByWheels::observe(const TimedCamera& last, const TimedCamera& camera, const Matrix6d& covariance,
                             const WheelScale& scale) {
  if (!wheels_) return;
  const std::optional<OdometryPlace> place = measuredAt(camera.time_ns);
  if (!place) return forget();
  const Located now{camera, covariance, *place};
  located_.add(last, now);
  const Located* before = nullptr;
  for (std::size_t back = 1; back < located_.size(); ++back) {
    const Located& located = located_.before(back);
    const double seconds = static_cast<double>(camera.time_ns - located.camera.time_ns) * 1e-9;
    if (seconds > longest_compared_s) break;
    before = &located;
    if (seconds >= shortest_compared_s) break;
  }
  if (!before || static_cast<double>(camera.time_ns - before->camera.time_ns) * 1e-9 < shortest_compared_s) return;
  const bool is_contradicted = contradicts(*before, now, scale);
  contradictions_ = is_contradicted ? contradictions_ + 1 : 0;
  agreements_ = is_contradicted ? 0 : agreements_ + 1;
  if (are_believed_ && contradictions_ >= contradictions_to_doubt) {
    are_believed_ = false;
    ++times_doubted_;
  } else if (!are_believed_ && agreements_ >= agreements_to_believe) {
    are_believed_ = true;
  }
}

std::optional<WheelPrediction> MotionByWheels::predict(const WheelDeparture& from, std::int64_t time_ns,
                                                       const WheelScale& scale,
                                                       const WheelPrediction& by_camera) const {
  if (!wheels_) return std::nullopt;
  const OdometryPlace now = at(time_ns);
  const std::optional<WheelMotion> moved = wheelMotion(*wheels_, from.place, now);
  std::optional<WheelMotion> since_located = wheelMotion(*wheels_, from.located, now);
  if (!moved || !since_located) return std::nullopt;
  WheelPrediction prediction = by_camera;
  prediction.stood =
      now.way_m - from.place.way_m < standing_way_m && now.turn_rad - from.place.turn_rad < standing_turn_rad;
  const Pose& last = from.last.world_T_camera;
  const double unit_m = scale.is_known ? scale.metres_a_unit : 1;
  since_located->first_T_second.translation /= unit_m;
  since_located->covariance.topRows<3>() /= unit_m;
  since_located->covariance.leftCols<3>() /= unit_m;
  const Pose& way = since_located->first_T_second;
  const Matrix6d covariance = carriedCovariance(from.covariance, way) + since_located->covariance;
  prediction.world_T_camera.rotation = (last.rotation * moved->first_T_second.rotation).normalized();
  prediction.covariance.bottomRightCorner<3, 3>() = covariance.bottomRightCorner<3, 3>();
  if (!scale.is_known) return prediction;
  prediction.world_T_camera.translation =
      last.translation + last.rotation * (moved->first_T_second.translation / unit_m);
  const Eigen::Vector3d way_now = way.rotation.conjugate() * way.translation;
  prediction.covariance = covariance;
  prediction.covariance.topLeftCorner<3, 3>() += squared(scale.sigma) * way_now * way_now.transpose();
  prediction.knows_position = true;
  return prediction;
}

}  // namespace edgeslam
