#include "mapping/initial_starts.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "geometry/epipolar.h"
#include "geometry/median.h"
#include "geometry/relative_rotation.h"
#include "geometry/triangulation.h"
#include "mapping/points_seen_by_both.h"

namespace edgeslam {
namespace {

constexpr std::size_t fewest_depths = 20;
constexpr double largest_start_sigma = 0.5;  // share of the inverse depth

InitialStart startOf(std::string method, const InitialFrames& frames, const InitialisationOptions& options) {
  InitialStart start;
  start.method = std::move(method);
  start.frames = spreadFrames(frames, options.frames_between + 1);
  return start;
}

// The inverse depth that these views tell of a point; 0 where they tell too little.
double triangulatedInverseDepth(const Camera& camera, const PointObservation& first,
                                const std::vector<TriangulationView>& views) {
  const TriangulationResult point = triangulate(camera, first.bearing, views);
  if (!point.converged || point.sigma > largest_start_sigma * point.inverse_depth) return 0;
  return point.inverse_depth;
}

// Brings the median of the positive inverse depths to 1 and gives that to the other points. Returns what translations
// must be multiplied by; nothing where too few points have a depth.
std::optional<double> bringMedianToOne(std::vector<double>& inverse_depths) {
  std::vector<double> known;
  std::copy_if(inverse_depths.begin(), inverse_depths.end(), std::back_inserter(known), [](double d) { return d > 0; });
  if (known.size() < fewest_depths) return std::nullopt;
  const double scale = upperMedian(known);
  for (double& inverse_depth : inverse_depths) inverse_depth = inverse_depth > 0 ? inverse_depth / scale : 1.0;
  return scale;
}

RelativePose relativePoseOfCorners(const Camera& camera, const TrackedFrame& first, const TrackedFrame& current) {
  std::vector<Eigen::Vector3d> first_bearings, current_bearings;
  forEachCommon(first, current, [&](std::size_t i, std::size_t j) {
    if (!first.observations[i].corner) return;
    first_bearings.push_back(first.observations[i].bearing);
    current_bearings.push_back(current.observations[j].bearing);
  });
  return relativePose(first_bearings, current_bearings, 1.0 / meanFocalLength(camera), /*seed=*/1);
}

// The frames' rotations, and how far the points moved beyond what these explain; none where too few are in common.
std::vector<RelativeRotation> rotationsOf(const InitialFrames& frames, const std::vector<std::size_t>& chosen) {
  constexpr std::size_t fewest_common = 8;
  std::vector<RelativeRotation> rotations;
  for (const std::size_t k : chosen) {
    const CommonBearings bearings = commonBearings(frames.first, frames.since[k]);
    if (bearings.in_first.size() < fewest_common) return {};
    rotations.push_back(relativeRotation(bearings.in_first, bearings.in_other));
  }
  return rotations;
}

}  // namespace

std::optional<InitialStart> withTriangulatedDepths(const Camera& camera, const InitialFrames& frames,
                                                   InitialStart start) {
  const TrackedFrame& first = frames.first;
  std::vector<std::vector<TriangulationView>> views(first.observations.size());
  for (std::size_t k = 0; k < start.frames.size(); ++k) {
    const TrackedFrame& frame = frames.since[start.frames[k]];
    forEachCommon(first, frame, [&](std::size_t i, std::size_t j) {
      views[i].push_back({start.first_T_camera[k].inverse(), frame.observations[j].measurement});
    });
  }
  start.inverse_depths.assign(first.observations.size(), 0.0);
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!views[i].empty()) start.inverse_depths[i] = triangulatedInverseDepth(camera, first.observations[i], views[i]);
  }
  const std::optional<double> scale = bringMedianToOne(start.inverse_depths);
  if (!scale) return std::nullopt;
  for (Pose& pose : start.first_T_camera) pose.translation *= *scale;
  return start;
}

InitialStart followedStart(const InitialFrames& frames, const std::vector<double>& provisional_inverse_depths,
                           const InitialisationOptions& options) {
  InitialStart start = startOf("flat start", frames, options);
  for (const std::size_t frame : start.frames) start.first_T_camera.push_back(frames.since[frame].world_T_camera);
  start.inverse_depths = provisional_inverse_depths;
  return start;
}

std::optional<InitialStart> fivePointStart(const Camera& camera, const InitialFrames& frames,
                                           const InitialisationOptions& options) {
  const TrackedFrame &first = frames.first, &current = frames.current();
  if (cornersSeen(frames) < options.five_point_corners) return std::nullopt;
  const RelativePose relative = relativePoseOfCorners(camera, first, current);
  if (!relative.found) return std::nullopt;

  InitialStart start = startOf("five-point", frames, options);
  start.inverse_depths.assign(first.observations.size(), 0.0);
  forEachCommon(first, current, [&](std::size_t i, std::size_t j) {
    start.inverse_depths[i] = triangulatedInverseDepth(
        camera, first.observations[i], {{relative.second_T_first, current.observations[j].measurement}});
  });
  const std::optional<double> scale = bringMedianToOne(start.inverse_depths);
  if (!scale) return std::nullopt;

  Pose first_T_current = relative.second_T_first.inverse();
  first_T_current.translation *= *scale;
  Pose before;
  for (const std::size_t frame : start.frames) {
    const bool is_current = frame + 1 == frames.since.size();
    const std::optional<Pose> pose =
        locateAgainst(camera, first, start.inverse_depths, frames.since[frame], is_current ? first_T_current : before);
    if (!pose) return std::nullopt;
    start.first_T_camera.push_back(*pose);
    before = *pose;
  }
  return start;
}

std::vector<InitialStart> steadyMotionStarts(const Camera& camera, const InitialFrames& frames,
                                             const InitialisationOptions& options) {
  struct Motion {
    const char* name;
    Eigen::Vector3d direction;
  };
  const Motion motions[] = {{"forward", {0, 0, 1}},
                            {"rightward", {1, 0, 0}},
                            {"leftward", {-1, 0, 0}},
                            {"downward", {0, 1, 0}},
                            {"upward", {0, -1, 0}}};
  std::vector<InitialStart> starts;
  const std::vector<std::size_t> chosen = startOf("", frames, options).frames;
  const std::vector<RelativeRotation> rotations = rotationsOf(frames, chosen);
  if (rotations.empty()) return starts;
  for (const auto& [name, direction] : motions) {
    InitialStart start = startOf(std::string(name) + " start", frames, options);
    for (const RelativeRotation& rotation : rotations) {
      // As far as the points moved beyond what the rotation explains; the unit comes from the depths.
      start.first_T_camera.push_back({rotation.rotation.conjugate(), rotation.median_error * direction});
    }
    std::optional<InitialStart> whole = withTriangulatedDepths(camera, frames, std::move(start));
    if (whole) starts.push_back(std::move(*whole));
  }
  return starts;
}

}  // namespace edgeslam
