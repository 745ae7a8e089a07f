#include "simulator/wheel_simulation.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "files/format_text.h"
#include "files/text_file.h"
#include "wheels/utime.h"

namespace edgeslam {
namespace {

constexpr double driving_after_last_frame_s = 0.05;
constexpr double scale_error = 1.01;               // of the wheels' size
constexpr double way_noise_per_root_metre = 0.01;  // [m/sqrt(m)]
constexpr double turn_noise_per_root_radian = 0.01;
constexpr double spinning_m_s = 0.5;  // faster than the robot moves

// Normally distributed, by Box and Muller's method; the same seed gives the same numbers.
class WheelNoise {
 public:
  explicit WheelNoise(std::uint64_t seed) : generator_(seed * 0x9E3779B97F4A7C15U + 0x776865656C73U) {}

  double of(double sigma) { return sigma * std::sqrt(-2 * std::log(uniform())) * std::cos(2 * M_PI * uniform()); }

 private:
  double uniform() { return (static_cast<double>(generator_() >> 11U) + 0.5) * 0x1p-53; }

  std::mt19937_64 generator_;
};

// Of the optical axis, against the x axis.
double heading(const Pose& world_T_camera) {
  const Eigen::Vector3d axis = world_T_camera.rotation * Eigen::Vector3d::UnitZ();
  return std::atan2(axis.y(), axis.x());
}

Eigen::Quaterniond turnedBy(double angle) { return rotationExp(angle * Eigen::Vector3d::UnitZ()); }

// What is driven in a step, as the robot sees it: forward along x, to the left, and turned.
struct Step {
  Eigen::Vector2d way;
  double turn;
};

Step stepBetween(const Pose& before, const Pose& now) {
  const Eigen::Vector3d way = turnedBy(-heading(before)) * (now.translation - before.translation);
  return {way.head<2>(), std::remainder(heading(now) - heading(before), 2 * M_PI)};
}

}  // namespace

std::vector<OdometryPose> simulateWheels(const SimulatedSequence& sequence) {
  const std::int64_t first_ns = sequence.time(0);
  const double interval_s = 1 / simulated_wheel_rate_hz;
  const double last_s = static_cast<double>(sequence.time(sequence.size() - 1) - first_ns) * 1e-9;
  const auto slips = [&](double time_s) {
    const auto frame = static_cast<int>(std::lround(time_s * sequence.options.fps));
    return std::any_of(sequence.options.slipped.begin(), sequence.options.slipped.end(),
                       [&](const FrameRange& range) { return range.contains(frame); });
  };
  WheelNoise noise(sequence.options.seed);
  Pose before = poseAt(sequence.motion, 0);
  const double height = before.translation.z();
  const Eigen::Quaterniond level_R_camera = turnedBy(-heading(before)) * before.rotation;
  double x = before.translation.x(), y = before.translation.y(), direction = heading(before);
  std::vector<OdometryPose> poses;
  for (int k = 0; k * interval_s <= last_s + driving_after_last_frame_s; ++k) {
    const double time_s = k * interval_s;
    const Pose now = poseAt(sequence.motion, time_s);
    Step step = stepBetween(before, now);
    step.way *= scale_error;
    if (k > 0 && slips(time_s)) step.way.x() += spinning_m_s * interval_s;
    step.way.x() += noise.of(way_noise_per_root_metre * std::sqrt(step.way.norm()));
    step.turn += noise.of(turn_noise_per_root_radian * std::sqrt(std::abs(step.turn)));
    const Eigen::Vector2d way = Eigen::Rotation2Dd(direction) * step.way;
    x += way.x();
    y += way.y();
    direction += step.turn;
    poses.push_back({utimeOf(first_ns) + std::llround(time_s * 1e6),
                     {(turnedBy(direction) * level_R_camera).normalized(), {x, y, height}}});
    before = now;
  }
  return poses;
}

std::string formatWheelOdometry(const std::vector<OdometryPose>& poses) {
  std::string text = "# wheel odometry: pose of the camera\n# timestamp tx ty tz qx qy qz qw\n";
  for (const OdometryPose& pose : poses) {
    const Eigen::Vector3d& t = pose.local_T_body.translation;
    const Eigen::Quaterniond& q = pose.local_T_body.rotation;
    text += formatStamp(1000 * pose.utime) +
            formatted(" %.6f %.6f %.6f %.7f %.7f %.7f %.7f\n", t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
  }
  return text;
}

}  // namespace edgeslam
