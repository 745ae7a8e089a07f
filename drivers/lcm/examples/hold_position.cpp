// A controller that holds the place where the robot stood at the first pose. It steers by SLAM_ODOMETRY, which never
// jumps; where the place is in `odom`, SLAM_CORRECTION tells anew whenever the map is corrected. Prints a velocity
// command in the body's frame for each pose, and `stop` where the pose is lost or nothing is heard. In another map
// (correction_t.world) the place has no coordinates: it stops until the robot is back in the map of the place. Needs
// LCM and the generated types only; the URL is LCM_DEFAULT_URL. Build:
//   lcm-gen --cpp --cpp-std=c++11 types/*.lcm && g++ -std=c++17 hold_position.cpp -I. -llcm -o hold_position
#include <algorithm>
#include <array>
#include <chrono>
#include <edgeslam/correction_t.hpp>
#include <edgeslam/pose_t.hpp>
#include <edgeslam/state_t.hpp>
#include <iostream>
#include <lcm/lcm-cpp.hpp>
#include <string>

namespace {

using Clock = std::chrono::steady_clock;
using Vector = std::array<double, 3>;

constexpr double gain_per_s = 0.8;
constexpr double highest_speed = 0.3;  // [m/s; map units/s while the scale is unknown]
constexpr std::chrono::milliseconds longest_silence(300);

// v turned by a quaternion w, x, y, z.
Vector turned(const double (&q)[4], const Vector& v) {
  const Vector u{q[1], q[2], q[3]};
  const auto cross = [](const Vector& a, const Vector& b) {
    return Vector{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  const Vector once = cross(u, v), twice = cross(u, once);
  return {v[0] + 2 * (q[0] * once[0] + twice[0]), v[1] + 2 * (q[0] * once[1] + twice[1]),
          v[2] + 2 * (q[0] * once[2] + twice[2])};
}

// Into the frame whose place and orientation in another one are given: by the inverse.
Vector into(const double (&position)[3], const double (&q)[4], const Vector& point) {
  const double inverse[4] = {q[0], -q[1], -q[2], -q[3]};
  return turned(inverse, {point[0] - position[0], point[1] - position[1], point[2] - position[2]});
}

// Out of it.
Vector outOf(const double (&position)[3], const double (&q)[4], const Vector& point) {
  const Vector ahead = turned(q, point);
  return {ahead[0] + position[0], ahead[1] + position[1], ahead[2] + position[2]};
}

class Controller {
 public:
  void onCorrection(const lcm::ReceiveBuffer*, const std::string&, const edgeslam::correction_t* correction) {
    correction_ = *correction;  // comes before the pose
  }

  void onOdometry(const lcm::ReceiveBuffer*, const std::string&, const edgeslam::pose_t* pose) {
    if (!correction_.is_measured) return;
    if (!has_target_) {
      target_ = outOf(correction_.translation, correction_.rotation, {pose->pos[0], pose->pos[1], pose->pos[2]});
      target_world_ = correction_.world;
    }
    has_target_ = true;
    if (correction_.world != target_world_) return stop("another map");
    const Vector in_odom = into(correction_.translation, correction_.rotation, target_);
    Vector command = into(pose->pos, pose->orientation, in_odom);  // from the body to the place
    for (double& speed : command) speed = std::clamp(gain_per_s * speed, -highest_speed, highest_speed);
    std::cout << "velocity " << command[0] << " " << command[1] << " " << command[2] << std::endl;
    heard_ = Clock::now();
    moving_ = true;
  }

  void onState(const lcm::ReceiveBuffer*, const std::string&, const edgeslam::state_t* state) {
    if (!state->has_pose || state->state == edgeslam::state_t::PREDICTED) stop("no measured pose: " + state->reason);
  }

  void stopIfSilent() {
    if (Clock::now() - heard_ > longest_silence) stop("silence");
  }

 private:
  void stop(const std::string& why) {
    if (moving_) std::cout << "stop: " << why << std::endl;
    moving_ = false;
  }

  bool has_target_ = false, moving_ = true;
  edgeslam::correction_t correction_{};
  int target_world_ = 0;
  Vector target_{};  // in `local`
  Clock::time_point heard_ = Clock::now();
};

}  // namespace

int main() {
  lcm::LCM lcm;
  if (!lcm.good()) return 1;
  Controller controller;
  // The latest message counts; older ones are of no use to a controller.
  lcm.subscribe("SLAM_CORRECTION", &Controller::onCorrection, &controller)->setQueueCapacity(1);
  lcm.subscribe("SLAM_ODOMETRY", &Controller::onOdometry, &controller)->setQueueCapacity(1);
  lcm.subscribe("SLAM_STATE", &Controller::onState, &controller)->setQueueCapacity(1);
  std::cout << "ready" << std::endl;
  while (lcm.handleTimeout(50) >= 0) controller.stopIfSilent();
  return 1;
}
