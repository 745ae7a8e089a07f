#include "simulator/hand_motion.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "geometry/angles.h"

namespace edgeslam {
namespace {

using Eigen::Vector3d;

constexpr double pi = 3.14159265358979323846;
constexpr double corridor_step_s = 0.005;
constexpr double braking_time_s = 0.4;
constexpr double shake_rise_s = 0.15;
constexpr double panels_period_s = 26;
constexpr double room_period_s = 26;

// Corridor: a rounded rectangle in the middle of the corridors, begun in the middle of the side at y = 0,
// counter-clockwise.
constexpr double turn_radius_m = 0.6;
constexpr double corridor_speed_m_s = 1.0;
constexpr double turn_speed_m_s = 0.45;
constexpr double easing_m = 0.35;  // way over which the heading follows a turn
constexpr double corridor_camera_height_m = 0.9;

double smoothStep(double x) {
  const double c = std::clamp(x, 0.0, 1.0);
  return c * c * (3 - 2 * c);
}

// Integral of smoothStep from 0 to x.
double smoothStepIntegral(double x) {
  const double c = std::clamp(x, 0.0, 1.0);
  return c * c * c - 0.5 * c * c * c * c + std::max(0.0, x - 1);
}

// Time on the motion's own clock, which stands while the camera is held still.
double motionTime(const CameraMotion& motion, double time_s) {
  double result = time_s;
  for (const TimeSpan& span : motion.still) {
    // The clock loses `smoothStep` of each second while braking, all of it in the span, 1 - smoothStep when starting
    // again.
    const double falling = (time_s - (span.begin_s - braking_time_s)) / braking_time_s;
    const double rising = (time_s - span.end_s) / braking_time_s;
    result -= braking_time_s * (smoothStepIntegral(falling) - smoothStepIntegral(rising));
  }
  return result;
}

double sumOf(const std::vector<Sway>& sways, double time_s) {
  double sum = 0;
  for (const Sway& s : sways) sum += s.amplitude * std::sin(2 * pi * s.frequency_hz * time_s + s.phase);
  return sum;
}

Vector6d swayAt(const std::array<std::vector<Sway>, 6>& sways, double time_s) {
  Vector6d sway;
  for (int i = 0; i < 6; ++i) sway[i] = sumOf(sways[static_cast<std::size_t>(i)], time_s);
  return sway;
}

// About the camera's y axis [rad]: to the side in the first half of a span, back in the second.
double turnAt(const CameraMotion& motion, double time_s) {
  double angle = 0;
  for (const TimeSpan& span : motion.turned) {
    const double half_s = (span.end_s - span.begin_s) / 2;
    angle +=
        motion.turn_rad * smoothStep((time_s - span.begin_s) / half_s) * smoothStep((span.end_s - time_s) / half_s);
  }
  return angle;
}

// Camera at `position` that looks along `forward`, upright.
Pose lookAlong(const Vector3d& position, const Vector3d& forward) {
  Eigen::Matrix3d rotation;
  const Vector3d z = forward.normalized(), x = z.cross(Vector3d::UnitZ()).normalized();
  rotation << x, z.cross(x), z;
  return {Eigen::Quaterniond(rotation).normalized(), position};
}

Pose panelsPath(double phase, bool near) {
  // Sideways and back at 2.3 m from the bare panels, at about 1 m from the posters.
  const double x = -1.15 * std::cos(phase);
  const double y = near ? -1.22 + 0.10 * std::sin(1.7 * phase) : -2.32 + 0.16 * std::sin(1.3 * phase);
  const double z = near ? 1.10 + 0.12 * std::sin(2.3 * phase + 1) : 1.28 + 0.10 * std::sin(2.1 * phase + 1);
  const double yaw = (near ? 0.30 : 0.16) * std::sin(1.9 * phase + 0.5);
  const double pitch = (near ? -0.16 : -0.15) + 0.05 * std::sin(2.7 * phase);
  return lookAlong({x, y, z}, {std::sin(yaw), std::cos(yaw), pitch});
}

Pose roomPath(double phase) {
  // A walk round the room that looks across it.
  const Vector3d position(2.6 + 1.15 * std::cos(phase), 2.1 + 0.85 * std::sin(phase),
                          1.45 + 0.08 * std::sin(3 * phase));
  const double yaw = phase + pi + 0.45 * std::sin(2 * phase);
  return lookAlong(position, {std::cos(yaw), std::sin(yaw), -0.14 + 0.08 * std::sin(2 * phase + 1)});
}

struct CorridorPath {
  double side_x, side_y;  // straight parts [m]
  double corner = turn_radius_m * pi / 2;
  double lap() const { return 2 * (side_x + side_y) + 4 * corner; }
};

CorridorPath corridorPath() {
  const CorridorPlan plan;
  return {plan.length - plan.corridor_width - 2 * turn_radius_m, plan.width - plan.corridor_width - 2 * turn_radius_m};
}

struct PathPoint {
  Vector3d position;
  double heading = 0;        // [rad], not wrapped
  double way_to_turn_m = 0;  // along the path to the nearest turn, 0 in it
};

PathPoint corridorPoint(double way_m) {
  const CorridorPlan plan;
  const CorridorPath path = corridorPath();
  const double middle = 0.5 * plan.corridor_width;
  const double laps = std::floor(way_m / path.lap());
  double rest = way_m - laps * path.lap();
  // Half a side, then four times a turn and a side; the last side is the first one's other half.
  Vector3d position(0.5 * plan.length, middle, corridor_camera_height_m);
  double heading = 2 * pi * laps;
  const std::array<double, 5> sides = {path.side_x / 2, path.side_y, path.side_x, path.side_y, path.side_x / 2};
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Vector3d forward(std::cos(heading), std::sin(heading), 0), left(-forward.y(), forward.x(), 0);
    if (rest <= sides[i] || i + 1 == sides.size()) {
      double to_turn = sides[i] - rest;
      if (i > 0) to_turn = std::min(to_turn, rest);
      // Before the first turn and after the last, the nearest turn is the one on the far side of the start.
      return {position + rest * forward, heading, i + 1 == sides.size() ? rest : to_turn};
    }
    position += sides[i] * forward;
    rest -= sides[i];
    if (rest <= path.corner) {
      const double angle = rest / turn_radius_m;
      return {position + turn_radius_m * (std::sin(angle) * forward + (1 - std::cos(angle)) * left), heading + angle,
              0};
    }
    position += turn_radius_m * (forward + left);
    heading += pi / 2;
    rest -= path.corner;
  }
  return {position, heading, 0};
}

double corridorSpeed(double way_m) {
  return turn_speed_m_s +
         (corridor_speed_m_s - turn_speed_m_s) * smoothStep((corridorPoint(way_m).way_to_turn_m - 0.2) / 0.8);
}

Pose corridorPose(double way_m) {
  // The heading is averaged over some way, so that the turning sets in gently.
  constexpr int samples = 21;
  double heading = 0;
  for (int i = 0; i < samples; ++i) {
    heading += corridorPoint(way_m + easing_m * (2.0 * i / (samples - 1) - 1)).heading / samples;
  }
  return lookAlong(corridorPoint(way_m).position, {std::cos(heading), std::sin(heading), -0.03});
}

// A quadratic spline: with steps in the speed an inertial unit would feel blows.
double wayGone(const std::vector<double>& distances, double time_s) {
  const double position = std::clamp(time_s / corridor_step_s, 0.0, static_cast<double>(distances.size()) - 2.5);
  if (position < 0.5) return distances[0] + position * (distances[1] - distances[0]);
  const std::size_t i = static_cast<std::size_t>(position - 0.5);
  const double share = position - 0.5 - static_cast<double>(i);
  return 0.5 * (1 - share) * (1 - share) * distances[i] + (0.5 + share * (1 - share)) * distances[i + 1] +
         0.5 * share * share * distances[i + 2];
}

// Uniform in [0, 1); std::uniform_real_distribution differs between libraries.
double uniform(std::mt19937_64& generator) { return static_cast<double>(generator() >> 11U) * 0x1p-53; }

std::vector<Sway> makeSways(int count, double slowest_hz, double fastest_hz, double amplitude,
                            std::mt19937_64& generator) {
  std::vector<Sway> sways;
  for (int i = 0; i < count; ++i) {
    const double share = (i + 0.8 * uniform(generator)) / count;
    const double frequency = slowest_hz * std::pow(fastest_hz / slowest_hz, share);
    // The slower, the wider, so that each contributes alike to the speed.
    sways.push_back({amplitude * slowest_hz / frequency / std::sqrt(count), frequency, 2 * pi * uniform(generator)});
  }
  return sways;
}

}  // namespace

CameraMotion makeCameraMotion(SceneKind scene, double speed, std::uint64_t seed, double duration_s) {
  std::mt19937_64 generator(seed * 0x9E3779B97F4A7C15U + 0x6D6F74696F6EU);
  CameraMotion motion;
  motion.scene = scene;
  motion.speed = speed;
  const bool on_wheels = isCorridor(scene);
  for (std::size_t i = 0; i < 6; ++i) {
    const bool rotation = i >= 3;
    const double hand = rotation ? 0.030 : 0.030, wheels = rotation ? 0.004 : 0.0;
    motion.tremor[i] = makeSways(5, 0.25, 3.0, on_wheels ? wheels : hand, generator);
    // A flick of the wrist: up to some 200 degrees/s.
    motion.shake[i] = makeSways(3, 2.0, 4.5, rotation ? 0.12 : 0.02, generator);
  }
  switch (scene) {
    case SceneKind::room:
      motion.path_phase = -2.2 + 0.3 * uniform(generator);
      break;
    case SceneKind::corridor:
    case SceneKind::corridor_tiled: {
      const CorridorPath path = corridorPath();
      const double until_s = std::max(duration_s * speed + 1, path.lap() / turn_speed_m_s);
      double way = 0;
      for (double t = 0; t < until_s + 2 * corridor_step_s; t += corridor_step_s) {
        motion.corridor_distances_m.push_back(way);
        way += corridor_step_s * corridorSpeed(way);
      }
      break;
    }
    default:
      // Not at the turning point, where the camera hardly moves.
      motion.path_phase = 0.55 + 0.2 * uniform(generator);
  }
  return motion;
}

Pose poseAt(const CameraMotion& motion, double time_s) {
  const double time = motionTime(motion, time_s), path_time = motion.speed * time;
  Pose pose;
  switch (motion.scene) {
    case SceneKind::room:
      pose = roomPath(motion.path_phase + 2 * pi * path_time / room_period_s);
      break;
    case SceneKind::corridor:
    case SceneKind::corridor_tiled:
      pose = corridorPose(wayGone(motion.corridor_distances_m, path_time));
      break;
    default:
      pose = panelsPath(motion.path_phase + 2 * pi * path_time / panels_period_s,
                        motion.scene == SceneKind::panels_textured);
  }
  Vector6d sway = swayAt(motion.tremor, time);
  for (const TimeSpan& span : motion.shaken) {
    const double strength =
        smoothStep((time_s - span.begin_s) / shake_rise_s) * smoothStep((span.end_s - time_s) / shake_rise_s);
    if (strength > 0) sway += strength * swayAt(motion.shake, time_s);
  }
  pose = retract(pose, sway);
  const double turn = turnAt(motion, time_s);
  if (turn != 0) pose.rotation = pose.rotation * Eigen::Quaterniond(Eigen::AngleAxisd(turn, Vector3d::UnitY()));
  return pose;
}

double lapTime(const CameraMotion& motion) {
  switch (motion.scene) {
    case SceneKind::room:
      return room_period_s / motion.speed;
    case SceneKind::corridor:
    case SceneKind::corridor_tiled: {
      const auto& ways = motion.corridor_distances_m;
      const auto end = std::lower_bound(ways.begin(), ways.end(), corridorPath().lap());
      return corridor_step_s * static_cast<double>(end - ways.begin()) / motion.speed;
    }
    default:
      return panels_period_s / motion.speed;
  }
}

}  // namespace edgeslam
