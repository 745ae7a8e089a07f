#include "pipeline/final_poses.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "adjustment/motion_smoothing.h"
#include "geometry/median.h"
#include "map/worlds.h"

namespace edgeslam {
namespace {

constexpr int fewest_points = 30;    // that agree with the pose, and at least ...
constexpr double least_share = 0.5;  // ... of those that are in the map
// Standard deviation of the position that a frame was carried to, share of the scene's distance. What errs together
// makes measured positions err several times as far as they say: this is small beside what is carried to a wrong place.
constexpr double carried_sigma = 0.002;
constexpr double longest_step_s = 0.2;  // between frames that tell how the camera moved
constexpr int smoothing_iterations = 10;
// Between keyframes the mean speed changes less than the speed does: of frames, so many times as much is presumed ...
constexpr double walk_of_frames = 3;
constexpr std::ptrdiff_t walks_around = 8;  // ... as in the median of the nearest so many keyframes, but at least ...
constexpr double least_walk = 0.005;        // ... this: [rad/s], and share of the scene's distance
constexpr std::size_t fewest_walks = 3;
constexpr std::size_t enough_frames = 500;    // at once: memory does not grow with the run
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

PosePrior whereItWasCarried(const PoseObservations& observations, const Pose& world_T_camera) {
  std::vector<double> distances;
  for (const PoseObservation& o : observations) distances.push_back((o.point - world_T_camera.translation).norm());
  const double sigma = carried_sigma * upperMedian(distances);
  PosePrior prior{world_T_camera};
  prior.information.topLeftCorner<3, 3>() = Eigen::Matrix3d::Identity() / (sigma * sigma);
  return prior;
}

double secondsBetween(const FrameRecord& a, const FrameRecord& b) {
  return 1e-9 * static_cast<double>(b.time_ns - a.time_ns);
}

// As the frames before and after it in the same world tell it.
Twist motionAt(const std::deque<FrameRecord>& frames, std::size_t place) {
  const FrameRecord& frame = frames[place];
  const auto tells = [&](const FrameRecord& other) {
    return other.has_final_pose && other.final_world == frame.final_world &&
           std::abs(secondsBetween(frame, other)) <= longest_step_s;
  };
  const FrameRecord& before = place > 0 && tells(frames[place - 1]) ? frames[place - 1] : frame;
  const FrameRecord& after = place + 1 < frames.size() && tells(frames[place + 1]) ? frames[place + 1] : frame;
  const double seconds = secondsBetween(before, after);
  return seconds > 0 ? twistBetween(before.final_world_T_camera, after.final_world_T_camera, seconds) : Twist::Zero();
}

// Whether it has its pose from the map, and not from inertia or wheels alone.
bool showsTheMap(const Map& map, int world, const SeenPoints& seen) {
  int shown = 0;
  for (std::size_t i = 0; i < seen.points.size() && shown < fewest_points; ++i) {
    const auto found = map.points.find(seenPoint(seen, i).point);
    if (found != map.points.end() && map.keyframes[found->second.host].world == world) ++shown;
  }
  return shown == fewest_points;
}

// Frames in a row that show one world, without gaps: from `first` until before `end`. Where a row is long enough it
// ends with a keyframe, and the next one begins with it.
struct Row {
  std::size_t first = 0, end = 0;
};

std::vector<Row> rowsOf(const Map& map, SeenRecord& seen, const std::deque<FrameRecord>& frames) {
  std::vector<Row> rows;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const FrameRecord& frame = frames[i];
    if (!frame.has_final_pose || !(frame.is_keyframe || showsTheMap(map, frame.final_world, seen.of(i)))) continue;
    const double step_s = i > 0 ? secondsBetween(frames[i - 1], frame) : 0;
    const bool goes_on = !rows.empty() && rows.back().end == i && frame.final_world == frames[i - 1].final_world &&
                         step_s > 0 && step_s <= longest_step_s;
    if (!goes_on) rows.push_back({i, i});
    rows.back().end = i + 1;
    if (frame.is_keyframe && i - rows.back().first >= enough_frames) rows.push_back({i, i + 1});
  }
  return rows;
}

struct TimedWalk {
  double time_s = 0;
  SpeedWalk walk;
};

// How much the speed changed at each keyframe, in the order of time.
std::vector<TimedWalk> walksAtKeyframes(const std::vector<SmoothedFrame>& row) {
  std::vector<SmoothedFrame> keyframes;
  std::copy_if(row.begin(), row.end(), std::back_inserter(keyframes),
               [](const SmoothedFrame& frame) { return frame.is_fixed; });
  std::vector<TimedWalk> walks;
  for (std::size_t k = 2; k < keyframes.size(); ++k) {
    keyframes[k - 1].walk = {1, 1};
    const SpeedChange change = speedChange(keyframes[k - 2], keyframes[k - 1], keyframes[k]);
    const auto each_axis = [](const Eigen::Vector3d& all) { return all.norm() / std::sqrt(3.0); };
    walks.push_back(
        {keyframes[k - 1].time_s, {each_axis(change.residual.head<3>()), each_axis(change.residual.tail<3>())}});
  }
  return walks;
}

SpeedWalk walkAt(double time_s, const std::vector<TimedWalk>& walks, const SpeedWalk& least) {
  const auto isBefore = [](const TimedWalk& walk, double time) { return walk.time_s < time; };
  const auto here = std::lower_bound(walks.begin(), walks.end(), time_s, isBefore);
  const auto first = here - std::min(walks_around / 2, here - walks.begin());
  const auto last = first + std::min(walks_around, walks.end() - first);
  std::vector<double> positions, rotations;
  for (auto walk = first; walk != last; ++walk) {
    positions.push_back(walk->walk.position);
    rotations.push_back(walk->walk.rotation);
  }
  return {std::max(least.position, walk_of_frames * upperMedian(positions)),
          std::max(least.rotation, walk_of_frames * upperMedian(rotations))};
}

void smoothRow(const Camera& camera, const Map& map, const PoseOptions& options, const Row& row, SeenRecord& seen,
               std::deque<FrameRecord>& frames) {
  std::vector<SmoothedFrame> smoothed;
  std::vector<Twist> twists;
  for (std::size_t i = row.first; i < row.end; ++i) {
    const FrameRecord& frame = frames[i];
    smoothed.push_back(
        {secondsBetween(frames[row.first], frame), frame.final_world_T_camera, SpeedWalk(), frame.is_keyframe});
    twists.push_back(motionAt(frames, i));
  }
  const std::vector<TimedWalk> walks = walksAtKeyframes(smoothed);
  const int world = frames[row.first].final_world;
  const KeyframeId first = firstKeyframeOf(map, world);  // none of a world that had to go
  const double distance = first < 0 ? 0 : sceneDistance(map, keyframeOf(map, first));
  if (walks.size() < fewest_walks || !(distance > 0)) return;
  for (SmoothedFrame& frame : smoothed) frame.walk = walkAt(frame.time_s, walks, {least_walk * distance, least_walk});
  const std::vector<SmoothedFrame> start = smoothed;
  const FrameEquations measured = [&](std::size_t i, const Pose& world_T_camera) {
    const SeenPoints its = seen.of(row.first + i);
    return poseEquations(camera, {world_T_camera, twists[i]},
                         observationsOf(camera, map, world, its, start[i].world_T_camera), options);
  };
  smoothMotion(measured, smoothing_iterations, smoothed);
  for (std::size_t i = row.first; i < row.end; ++i) {
    frames[i].final_world_T_camera = smoothed[i - row.first].world_T_camera;
  }
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
                 whereItWasCarried(observations, carried.world_T_camera));
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

void smoothFrames(const Camera& camera, const Map& map, const PoseOptions& options, SeenRecord& seen,
                  std::deque<FrameRecord>& frames) {
  for (const Row& row : rowsOf(map, seen, frames)) smoothRow(camera, map, options, row, seen, frames);
}

}  // namespace edgeslam
