// A robot on wheels that drives in curves, as its camera and its wheels see it: truth, noise and faults are the test's.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "unit/lcm/made_frames.h"
#include "wheels/odometry_pose.h"

namespace edgeslam {

struct DrivenRobot {
  Pose body_T_camera{Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5), {0.3, 0.1, 0.4}};  // looks ahead [m]
  double metres_per_unit = 2.5;
  double seconds = 30;
  double position_sigma = 0.002;  // of the camera's poses [map units]
  double wheel_scale = 1;         // what the wheels say over what is true
  double slip_per_metre = 0;      // standard deviation after 1 m [m]
  // Share that the wheels turn too much at a time [s], by slip.
  std::function<double(double)> spin = [](double) { return 0.0; };
};

struct Drive {
  std::vector<MeasuredPose> frames;    // 30/s
  std::vector<OdometryPose> odometry;  // 50/s
};

// On the ground at a time [s], at most 60: 0.6 m/s, in curves to both sides.
inline Pose bodyAt(double time_s) {
  constexpr double step_s = 0.01, speed_m_s = 0.6;
  const auto heading = [](double t) { return 1.2 * std::sin(0.5 * t); };
  const auto moved = [&](double from_s, double for_s) -> Eigen::Vector3d {
    const double middle = heading(from_s + for_s / 2);
    return speed_m_s * for_s * Eigen::Vector3d(std::cos(middle), std::sin(middle), 0);
  };
  static const std::vector<Eigen::Vector3d> places = [&] {
    std::vector<Eigen::Vector3d> all{Eigen::Vector3d::Zero()};
    for (int i = 0; i < 6000; ++i) all.push_back(all.back() + moved(i * step_s, step_s));
    return all;
  }();
  const auto whole = static_cast<std::size_t>(time_s / step_s);
  const double from_s = static_cast<double>(whole) * step_s;
  return {rotationExp({0, 0, heading(time_s)}), places.at(whole) + moved(from_s, time_s - from_s)};
}

inline Drive drive(const DrivenRobot& robot, unsigned seed) {
  Random random(seed);
  const Pose world_T_local = {random.rotation(2), random.vector(5)};  // map units
  constexpr std::int64_t start_us = 7'000'000;
  Drive result;
  for (int i = 0; i < robot.seconds * 30; ++i) {
    const Pose camera_m = bodyAt(i / 30.0) * robot.body_T_camera;
    MeasuredPose frame;
    frame.time_ns = 1000 * (start_us + i * 1'000'000LL / 30);
    frame.world_T_camera = world_T_local * Pose{camera_m.rotation, camera_m.translation / robot.metres_per_unit};
    for (int k = 0; k < 3; ++k) frame.world_T_camera.translation[k] += random.normal(robot.position_sigma);
    frame.covariance_camera = 1e-6 * Matrix6d::Identity();
    frame.covariance_camera.topLeftCorner<3, 3>() *= robot.position_sigma * robot.position_sigma / 1e-6;
    result.frames.push_back(frame);
  }
  Pose wheels = {random.rotation(0), random.vector(3)}, before = bodyAt(0);
  for (int i = 0; i < robot.seconds * 50 + 5; ++i) {
    const Pose now = bodyAt(i / 50.0);
    Pose moved = before.inverse() * now;
    const double way = moved.translation.norm();
    const double factor = robot.wheel_scale * (1 + robot.spin(i / 50.0));
    const double slip = way > 0 ? random.normal(1) * robot.slip_per_metre * std::sqrt(way) / way : 0;
    moved.translation *= factor + slip;
    wheels = wheels * moved;
    before = now;
    result.odometry.push_back({start_us + i * 20'000LL, wheels});
  }
  return result;
}

// In the order of time, the odometry `late_s` behind.
template <class Takes>
void playBack(const Drive& drive, Takes& takes, double late_s = 0.05) {
  std::size_t next = 0;
  for (const MeasuredPose& frame : drive.frames) {
    const std::int64_t until_us = frame.time_ns / 1000 - std::llround(1e6 * late_s);
    for (; next < drive.odometry.size() && drive.odometry[next].utime <= until_us; ++next) {
      takes.add(drive.odometry[next]);
    }
    takes.add(frame);
  }
  for (; next < drive.odometry.size(); ++next) takes.add(drive.odometry[next]);
}

}  // namespace edgeslam
