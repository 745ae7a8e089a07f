// A controller that holds the place where the robot stood at the first pose: the least that a user of SLAM_POSE writes.
// Prints a velocity command in the body's frame for each pose, and `stop` where the pose is lost or nothing is heard.
// In another map (state_t.world) the place has no coordinates: it stops until the robot is back in the map of the
// place. Needs LCM and the generated types only; the URL is LCM_DEFAULT_URL. Build:
//   lcm-gen --cpp --cpp-std=c++11 types/*.lcm && g++ -std=c++17 hold_position.cpp -I. -llcm -o hold_position
#include <algorithm>
#include <array>
#include <chrono>
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

// v in `local` coordinates, turned to the body's: by the inverse of the pose's quaternion w, x, y, z.
Vector toBody(const double (&q)[4], const Vector& v) {
  const Vector u{-q[1], -q[2], -q[3]};
  const auto cross = [](const Vector& a, const Vector& b) {
    return Vector{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  const Vector once = cross(u, v), twice = cross(u, once);
  return {v[0] + 2 * (q[0] * once[0] + twice[0]), v[1] + 2 * (q[0] * once[1] + twice[1]),
          v[2] + 2 * (q[0] * once[2] + twice[2])};
}

class Controller {
 public:
  void onPose(const lcm::ReceiveBuffer*, const std::string&, const edgeslam::pose_t* pose) {
    if (!has_target_) {
      std::copy_n(pose->pos, 3, target_.begin());
      target_world_ = world_;
    }
    has_target_ = true;
    if (world_ != target_world_) return stop("another map");
    Vector command;
    for (std::size_t i = 0; i < 3; ++i) command[i] = gain_per_s * (target_[i] - pose->pos[i]);
    command = toBody(pose->orientation, command);
    for (double& speed : command) speed = std::clamp(speed, -highest_speed, highest_speed);
    std::cout << "velocity " << command[0] << " " << command[1] << " " << command[2] << std::endl;
    heard_ = Clock::now();
    moving_ = true;
  }

  void onState(const lcm::ReceiveBuffer*, const std::string&, const edgeslam::state_t* state) {
    if (state->has_pose) world_ = state->world;  // comes before the pose
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
  int world_ = 0, target_world_ = 0;
  Vector target_{};
  Clock::time_point heard_ = Clock::now();
};

}  // namespace

int main() {
  lcm::LCM lcm;
  if (!lcm.good()) return 1;
  Controller controller;
  // The latest message counts; older ones are of no use to a controller.
  lcm.subscribe("SLAM_POSE", &Controller::onPose, &controller)->setQueueCapacity(1);
  lcm.subscribe("SLAM_STATE", &Controller::onState, &controller)->setQueueCapacity(1);
  std::cout << "ready" << std::endl;
  while (lcm.handleTimeout(50) >= 0) controller.stopIfSilent();
  return 1;
}
