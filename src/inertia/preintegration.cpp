#include "inertia/preintegration.h"

namespace edgeslam {
namespace {

Vector6d stacked(const InertialBias& bias) {
  Vector6d both;
  both << bias.rate, bias.force;
  return both;
}

// How errors of two motions go into that of both; `rotation`: of the first one.
Matrix9d byFirst(const Eigen::Matrix3d& rotation, const PreintegratedMotion& second) {
  Matrix9d by_first = Matrix9d::Identity();
  by_first.block<3, 3>(0, 0) = second.rotation.toRotationMatrix().transpose();
  by_first.block<3, 3>(3, 0) = -rotation * skew(second.velocity);
  by_first.block<3, 3>(6, 0) = -rotation * skew(second.position);
  by_first.block<3, 3>(6, 3) = second.seconds * Eigen::Matrix3d::Identity();
  return by_first;
}

Matrix9d bySecond(const Eigen::Matrix3d& rotation) {
  Matrix9d by_second = Matrix9d::Identity();
  by_second.block<3, 3>(3, 3) = by_second.block<3, 3>(6, 6) = rotation;
  return by_second;
}

}  // namespace

PreintegratedMotion preintegrate(const InertialUnit& unit, const InertialSample& from, const InertialSample& to,
                                 const InertialBias& bias) {
  PreintegratedMotion motion;
  const double dt = static_cast<double>(to.time_ns - from.time_ns) * 1e-9;
  const Eigen::Vector3d rate = 0.5 * (from.rate + to.rate) - bias.rate;
  const Eigen::Vector3d force = 0.5 * (from.force + to.force) - bias.force;
  const Eigen::Matrix3d halfway = rotationExp(0.5 * dt * rate).toRotationMatrix();
  motion.seconds = dt;
  motion.rotation = rotationExp(dt * rate);
  motion.velocity = dt * (halfway * force);
  motion.position = 0.5 * dt * motion.velocity;
  motion.bias = bias;
  // Turns between two samples are small: the right Jacobian of SO(3) is as good as the identity.
  const Eigen::Matrix3d by_turn = halfway * skew(force);
  motion.by_bias.block<3, 3>(0, 0) = -dt * Eigen::Matrix3d::Identity();
  motion.by_bias.block<3, 3>(3, 0) = 0.5 * dt * dt * by_turn;
  motion.by_bias.block<3, 3>(3, 3) = -dt * halfway;
  motion.by_bias.bottomRows<3>() = 0.5 * dt * motion.by_bias.middleRows<3>(3);
  const double rate_variance = unit.rate_noise * unit.rate_noise, force_variance = unit.force_noise * unit.force_noise;
  motion.covariance.diagonal().segment<3>(0).setConstant(rate_variance * dt);
  motion.covariance.diagonal().segment<3>(3).setConstant(force_variance * dt);
  motion.covariance.diagonal().segment<3>(6).setConstant(force_variance * dt * dt * dt / 3);
  for (int i = 0; i < 3; ++i) {
    motion.covariance(3 + i, 6 + i) = motion.covariance(6 + i, 3 + i) = force_variance * dt * dt / 2;
  }
  return motion;
}

PreintegratedMotion withBias(const PreintegratedMotion& motion, const InertialBias& bias) {
  PreintegratedMotion changed = motion;
  const Eigen::Matrix<double, 9, 1> change = motion.by_bias * (stacked(bias) - stacked(motion.bias));
  changed.rotation = (motion.rotation * rotationExp(change.head<3>())).normalized();
  changed.velocity += change.segment<3>(3);
  changed.position += change.tail<3>();
  changed.bias = bias;
  return changed;
}

PreintegratedMotion joined(const PreintegratedMotion& before, const PreintegratedMotion& second) {
  const PreintegratedMotion first = withBias(before, second.bias);
  const Eigen::Matrix3d rotation = first.rotation.toRotationMatrix();
  PreintegratedMotion both;
  both.seconds = first.seconds + second.seconds;
  both.rotation = (first.rotation * second.rotation).normalized();
  both.velocity = first.velocity + rotation * second.velocity;
  both.position = first.position + second.seconds * first.velocity + rotation * second.position;
  both.bias = second.bias;
  const Matrix9d by_first = byFirst(rotation, second), by_second = bySecond(rotation);
  both.by_bias = by_first * first.by_bias + by_second * second.by_bias;
  both.covariance =
      by_first * first.covariance * by_first.transpose() + by_second * second.covariance * by_second.transpose();
  return both;
}

PreintegratedMotion remainder(const PreintegratedMotion& whole, const PreintegratedMotion& before) {
  const PreintegratedMotion first = withBias(before, whole.bias);
  const Eigen::Matrix3d back = first.rotation.toRotationMatrix().transpose();
  PreintegratedMotion rest;
  rest.seconds = whole.seconds - first.seconds;
  rest.rotation = (first.rotation.conjugate() * whole.rotation).normalized();
  rest.velocity = back * (whole.velocity - first.velocity);
  rest.position = back * (whole.position - first.position - rest.seconds * first.velocity);
  rest.bias = whole.bias;
  const Matrix9d by_first = byFirst(back.transpose(), rest), from_whole = bySecond(back);
  rest.by_bias = from_whole * (whole.by_bias - by_first * first.by_bias);
  rest.covariance =
      from_whole * (whole.covariance - by_first * first.covariance * by_first.transpose()) * from_whole.transpose();
  return rest;
}

}  // namespace edgeslam
