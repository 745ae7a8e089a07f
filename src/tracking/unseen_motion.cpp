#include "tracking/unseen_motion.h"

#include <algorithm>
#include <cmath>

namespace edgeslam {
namespace {

// Of turns by the wheels and by the gyroscope: of the standard deviation, and of the turn.
constexpr double contradicting_turn = 5, contradicting_turn_share = 0.1;

TimedCamera cameraOf(const FollowedFrame& frame) { return {frame.images->time_ns, frame.world_T_camera}; }

double secondsSince(const FollowedFrame& frame, std::int64_t time_ns) {
  return static_cast<double>(time_ns - frame.images->time_ns) * 1e-9;
}

Eigen::Quaterniond seenRotation(const FollowedFrame& frame) {
  return frame.world_T_camera.rotation * rotationExp(frame.seen_turn);
}

bool isWithin(const Matrix6d& covariance, double largest_position_deviation, double largest_rotation_deviation) {
  return std::sqrt(covariance.diagonal().head<3>().maxCoeff()) <= largest_position_deviation &&
         std::sqrt(covariance.diagonal().tail<3>().maxCoeff()) <= largest_rotation_deviation;
}

}  // namespace

void UnseenMotion::observe(const FollowedFrame& last, const FollowedFrame& now, double sigma, const MapView& view) {
  motion_.observe(cameraOf(last), cameraOf(now));
  inertia_.observe(cameraOf(last), cameraOf(now), sigma);
  if (now.is_by_wheels) return;
  if (view.initialised && !last.is_by_wheels) {
    inertia_.observeTurn(
        {last.images->time_ns, now.images->time_ns, (seenRotation(last).conjugate() * seenRotation(now)).normalized()});
  }
  wheels_.observe(cameraOf(last), cameraOf(now), now.covariance, view.wheels);
  located_place_ = now.wheels;
  located_covariance_ = now.covariance;
  located_ns_ = now.images->time_ns;
}

void UnseenMotion::observeCoarsely(const FollowedFrame& last, const FollowedFrame& now) {
  motion_.observe(cameraOf(last), cameraOf(now));
}

void UnseenMotion::forget() {
  motion_.forget();
  inertia_.forget();
  wheels_.forget();
}

void UnseenMotion::goOnFrom(const FollowedFrame& last) {
  forget();
  located_place_ = last.wheels;
  located_covariance_ = last.covariance;
  located_ns_ = last.images->time_ns;
}

void UnseenMotion::scale(double factor) {
  motion_.scale(factor);
  if (factor == 1) return;
  inertia_.forget();
  wheels_.forget();
}

InertialPrediction UnseenMotion::byCamera(const FollowedFrame& last, std::int64_t time_ns) const {
  return {motion_.predict(cameraOf(last), time_ns),
          MotionModel::predictedCovariance(last.covariance, secondsSince(last, time_ns)), false};
}

std::optional<WheelPrediction> UnseenMotion::byWheels(const FollowedFrame& last, std::int64_t time_ns,
                                                      const MapView& view) const {
  if (!has_wheels_ || last.wheels.piece < 0) return std::nullopt;
  const InertialPrediction by_camera = byCamera(last, time_ns);
  std::optional<WheelPrediction> prediction =
      wheels_.predict({cameraOf(last), last.wheels, located_place_, located_covariance_}, time_ns, view.wheels,
                      {by_camera.world_T_camera, by_camera.covariance, false, false});
  if (prediction && !turnByGyroscope(last, time_ns, view, *prediction)) return std::nullopt;
  return prediction;
}

// False where the wheels turned otherwise: they slip. Their way was turned as they say: half of what is wrong of that.
bool UnseenMotion::turnByGyroscope(const FollowedFrame& last, std::int64_t time_ns, const MapView& view,
                                   WheelPrediction& prediction) const {
  const std::optional<InertialTurn> turn = inertia_.turnBetween(last.images->time_ns, time_ns, view.inertia);
  if (!turn) return true;
  Pose& pose = prediction.world_T_camera;
  const Eigen::Quaterniond& from = last.world_T_camera.rotation;
  const Eigen::Quaterniond by_wheels = from.conjugate() * pose.rotation;
  const Eigen::Vector3d error = rotationLog((turn->first_R_second * by_wheels.conjugate()).normalized());
  const double sigma = std::sqrt(prediction.covariance.diagonal().tail<3>().maxCoeff() + turn->variance);
  const double turned = rotationAngle(turn->first_R_second, Eigen::Quaterniond::Identity());
  if (error.norm() > contradicting_turn * sigma + contradicting_turn_share * turned) return false;
  pose.rotation = (from * turn->first_R_second).normalized();
  if (prediction.knows_position) {
    const Eigen::Vector3d& start = last.world_T_camera.translation;
    pose.translation = start + from * (rotationExp(0.5 * error) * (from.conjugate() * (pose.translation - start)));
  }
  Matrix6d& covariance = prediction.covariance;
  const Eigen::Vector3d variances = last.covariance.diagonal().tail<3>().array() + turn->variance;
  for (int axis = 0; axis < 3; ++axis) {
    if (variances[axis] >= covariance(3 + axis, 3 + axis)) continue;
    covariance.row(3 + axis).setZero();
    covariance.col(3 + axis).setZero();
    covariance(3 + axis, 3 + axis) = variances[axis];
  }
  return true;
}

InertialPrediction UnseenMotion::predict(const FollowedFrame& last, std::int64_t time_ns, const MapView& view) const {
  const std::optional<WheelPrediction> by_wheels = byWheels(last, time_ns, view);
  if (by_wheels && by_wheels->knows_position) return {by_wheels->world_T_camera, by_wheels->covariance, false};
  const InertialPrediction by_camera = byCamera(last, time_ns);
  const std::optional<InertialPrediction> by_inertia =
      inertia_.predict(cameraOf(last), last.covariance, time_ns, view.inertia, by_camera);
  if (by_wheels && !(by_inertia && by_inertia->knows_position)) {
    return {by_wheels->world_T_camera, by_wheels->covariance, false};
  }
  return by_inertia.value_or(by_camera);
}

RowMotion UnseenMotion::whileRowsAreRead(const FollowedFrame& last, std::int64_t time_ns, bool map_stands) const {
  return motion_.whileRowsAreRead(cameraOf(last), time_ns, map_stands);
}

bool UnseenMotion::isKnownByInertia(const InertialPrediction& prediction, const FollowedFrame& last,
                                    std::int64_t time_ns) const {
  return prediction.knows_position && secondsSince(last, time_ns) <= inertia_only_.longest_s &&
         isWithin(prediction.covariance, inertia_only_.largest_position_deviation * last.scene_depth,
                  inertia_only_.largest_rotation_deviation);
}

std::optional<WheelPrediction> UnseenMotion::carriedByWheels(const FollowedFrame& last, const FollowedFrame& frame,
                                                             std::int64_t time_ns, const MapView& view) const {
  std::optional<WheelPrediction> prediction = byWheels(last, time_ns, view);
  if (!prediction || !prediction->knows_position ||
      static_cast<double>(time_ns - located_ns_) * 1e-9 > wheels_only_.longest_s ||
      !isWithin(prediction->covariance, wheels_only_.largest_position_deviation * last.scene_depth,
                wheels_only_.largest_rotation_deviation)) {
    return std::nullopt;
  }
  const bool is_of_frame = frame.isThere() && frame.images->time_ns == time_ns && frame.edges && last.edges;
  const bool image_changed =
      is_of_frame && static_cast<double>(frame.edges->points.size()) >=
                         wheels_only_.contradicting_edges * static_cast<double>(last.edges->points.size());
  if (prediction->stood && image_changed) return std::nullopt;
  return prediction;
}

}  // namespace edgeslam
