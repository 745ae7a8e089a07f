#include "pipeline/final_poses.h"

#include <cmath>
#include <vector>

#include "geometry/median.h"

namespace edgeslam {
namespace {

constexpr int fewest_points = 30;    // that agree with the pose, and at least ...
constexpr double least_share = 0.5;  // ... of those that are in the map
// Standard deviation of the position that a frame was carried to, share of the scene's distance. What errs together
// makes measured positions err several times as far as they say: this is small beside what is carried to a wrong place.
constexpr double carried_sigma = 0.002;
constexpr double longest_step_s = 0.2;        // between frames that tell how the camera moved
constexpr int rounds_of_rolling_shutter = 2;  // the frames' poses tell the motion, which tells their poses

PoseObservations observationsOf(const Camera& camera, const Map& map, int world, const SeenPoints& seen,
                                const Pose& world_T_camera) {
  PoseObservations observations;
  observations.reserve(seen.points.size());
  const Pose camera_T_world = world_T_camera.inverse();
  for (std::size_t i = 0; i < seen.points.size(); ++i) {
    const SeenPoint one = seenPoint(seen, i);
    const auto found = map.points.find(one.point);
    if (found == map.points.end()) continue;
    const MapPoint& point = found->second;
    const Keyframe& host = map.keyframes[point.host];
    if (host.world != world) continue;
    observations.push_back(observeWithDepth(camera, camera_T_world * host.world_T_camera,
                                            {point.host_bearing, point.inverse_depth, point.inverse_depth_sigma},
                                            worldPosition(map, point), one.measurement));
  }
  return observations;
}

PositionPrior whereItWasCarried(const PoseObservations& observations, const Eigen::Vector3d& position) {
  std::vector<double> distances;
  for (const PoseObservation& observation : observations) distances.push_back((observation.point - position).norm());
  const double sigma = carried_sigma * upperMedian(distances);
  return {position, Eigen::Matrix3d::Identity() / (sigma * sigma)};
}

// As the frames before and after it in the same world tell it.
Twist motionAt(const std::deque<FrameRecord>& frames, std::size_t place) {
  const FrameRecord& frame = frames[place];
  const auto tells = [&](const FrameRecord& other) {
    const double seconds = 1e-9 * static_cast<double>(std::abs(other.time_ns - frame.time_ns));
    return other.has_final_pose && other.final_world == frame.final_world && seconds <= longest_step_s;
  };
  const FrameRecord& before = place > 0 && tells(frames[place - 1]) ? frames[place - 1] : frame;
  const FrameRecord& after = place + 1 < frames.size() && tells(frames[place + 1]) ? frames[place + 1] : frame;
  const double seconds = 1e-9 * static_cast<double>(after.time_ns - before.time_ns);
  return seconds > 0 ? twistBetween(before.final_world_T_camera, after.final_world_T_camera, seconds) : Twist::Zero();
}

}  // namespace

std::optional<Pose> locateAnew(const Camera& camera, const Map& map, int world, const SeenPoints& seen,
                               const MovingCamera& carried, const PoseOptions& options) {
  const PoseObservations observations = observationsOf(camera, map, world, seen, carried.world_T_camera);
  if (static_cast<int>(observations.size()) < fewest_points) return std::nullopt;
  RowMotion motion;
  motion.before = carried.twist;
  const PoseResult pose =
      adjustPose(camera, carried.world_T_camera, observations, options, std::pmr::get_default_resource(), motion,
                 whereItWasCarried(observations, carried.world_T_camera.translation));
  const double enough = std::max<double>(fewest_points, least_share * static_cast<double>(observations.size()));
  if (!pose.converged || pose.inlier_count < enough) return std::nullopt;
  return pose.world_T_camera;
}

void locateFramesAnew(const Camera& camera, const Map& map, const PoseOptions& options, SeenRecord& seen,
                      std::deque<FrameRecord>& frames) {
  std::vector<Pose> carried;
  for (const FrameRecord& frame : frames) carried.push_back(frame.final_world_T_camera);
  const int rounds = camera.readout_s != 0 ? rounds_of_rolling_shutter : 1;
  for (int round = 0; round < rounds; ++round) {
    std::vector<std::optional<Pose>> poses(frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const FrameRecord& frame = frames[i];
      if (!frame.has_final_pose || frame.is_keyframe) continue;
      poses[i] = locateAnew(camera, map, frame.final_world, seen.of(i), {carried[i], motionAt(frames, i)}, options);
    }
    for (std::size_t i = 0; i < frames.size(); ++i) {
      if (poses[i]) frames[i].final_world_T_camera = *poses[i];
    }
  }
}

}  // namespace edgeslam
