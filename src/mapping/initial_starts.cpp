// The starts that the initialisation tries (P14 and design, section 5): what tracking followed against a flat map, the
// five-point algorithm, and steady motions along the axes.
#include <algorithm>
#include <cmath>

#include "adjustment/pose_adjustment.h"
#include "geometry/epipolar.h"
#include "geometry/relative_rotation.h"
#include "geometry/triangulation.h"
#include "mapping/initialisation.h"
#include "mapping/points_seen_by_both.h"

namespace edgeslam {

std::vector<InitialStructure> Initialisation::rivals() const {
  std::vector<InitialStructure> structures;
  const auto corners = std::count_if(frames_.back().observations.begin(), frames_.back().observations.end(),
                                     [](const PointObservation& o) { return o.corner; });
  if (corners >= options_.five_point_corners) structures.push_back(fivePointStart());
  structures.push_back(directionStart({0, 0, 1}, "forward"));
  structures.push_back(directionStart({1, 0, 0}, "rightward"));
  structures.push_back(directionStart({-1, 0, 0}, "leftward"));
  structures.push_back(directionStart({0, 1, 0}, "downward"));
  structures.push_back(directionStart({0, -1, 0}, "upward"));
  return structures;
}

// What tracking followed against the flat map, freed and adjusted.
InitialStructure Initialisation::followedStart() const {
  InitialStructure structure;
  structure.method = "flat start";
  structure.frames = chooseFrames();
  for (const std::size_t frame : structure.frames) structure.first_T_camera.push_back(frames_[frame].world_T_camera);
  structure.inverse_depths = inverse_depths_;
  return adjust(std::move(structure));
}

// P14: the pose of the current frame by the five-point algorithm, depths by triangulation, the frames between by their
// points.
InitialStructure Initialisation::fivePointStart() const {
  InitialStructure structure;
  structure.method = "five-point";
  const TrackedFrame& current = frames_.back();
  std::vector<Eigen::Vector3d> first_bearings, current_bearings;
  forEachCommon(first_, current, [&](std::size_t i, std::size_t j) {
    if (!first_.observations[i].corner) return;
    first_bearings.push_back(first_.observations[i].bearing);
    current_bearings.push_back(current.observations[j].bearing);
  });
  const RelativePose relative =
      relativePose(first_bearings, current_bearings, 1.0 / meanFocalLength(camera_), /*seed=*/1);
  if (!relative.found) return structure;

  structure.inverse_depths.assign(first_.observations.size(), 0.0);
  std::vector<double> depths;
  forEachCommon(first_, current, [&](std::size_t i, std::size_t j) {
    const TriangulationResult point = triangulate(camera_, first_.observations[i].bearing,
                                                  {{relative.second_T_first, current.observations[j].measurement}});
    if (!point.converged || point.sigma > 0.5 * point.inverse_depth) return;
    structure.inverse_depths[i] = point.inverse_depth;
    depths.push_back(point.inverse_depth);
  });
  if (depths.size() < 20) return structure;
  const double scale = median(depths);  // brings the median inverse depth to 1
  for (double& inverse_depth : structure.inverse_depths)
    inverse_depth = inverse_depth > 0 ? inverse_depth / scale : 1.0;

  Pose last_first_T_camera;
  const Pose current_first_T_camera = [&] {
    Pose pose = relative.second_T_first.inverse();
    pose.translation *= scale;
    return pose;
  }();
  structure.frames = chooseFrames();
  for (const std::size_t frame : structure.frames) {
    PoseObservations observations;
    forEachCommon(first_, frames_[frame], [&](std::size_t i, std::size_t j) {
      PoseObservation observation;
      observation.point = first_.observations[i].bearing / structure.inverse_depths[i];
      observation.measurement = frames_[frame].observations[j].measurement;
      observations.push_back(observation);
    });
    const bool is_current = frame + 1 == frames_.size();
    const PoseResult pose =
        adjustPose(camera_, is_current ? current_first_T_camera : last_first_T_camera, observations, PoseOptions());
    if (!pose.converged) return structure;
    structure.first_T_camera.push_back(pose.world_T_camera);
    last_first_T_camera = pose.world_T_camera;
  }
  return adjust(std::move(structure));
}

// A camera that moved steadily in one direction of the first frame, turning as the points' bearings say; depths by
// triangulation.
InitialStructure Initialisation::directionStart(const Eigen::Vector3d& direction, const char* name) const {
  InitialStructure structure;
  structure.method = std::string(name) + " start";
  structure.frames = chooseFrames();
  std::vector<double> lengths;
  for (const std::size_t k : structure.frames) {
    std::vector<Eigen::Vector3d> first, other;
    forEachCommon(first_, frames_[k], [&](std::size_t i, std::size_t j) {
      first.push_back(first_.observations[i].bearing);
      other.push_back(frames_[k].observations[j].bearing);
    });
    if (first.size() < 8) return structure;
    const RelativeRotation rotation = relativeRotation(first, other);
    lengths.push_back(rotation.median_error);
    structure.first_T_camera.push_back(Pose{rotation.rotation.conjugate(), Eigen::Vector3d::Zero()});
  }
  for (std::size_t k = 0; k < lengths.size(); ++k) structure.first_T_camera[k].translation = lengths[k] * direction;

  std::vector<std::vector<TriangulationView>> views(first_.observations.size());
  for (std::size_t k = 0; k < structure.frames.size(); ++k) {
    const TrackedFrame& frame = frames_[structure.frames[k]];
    forEachCommon(first_, frame, [&](std::size_t i, std::size_t j) {
      views[i].push_back({structure.first_T_camera[k].inverse(), frame.observations[j].measurement});
    });
  }
  structure.inverse_depths.assign(first_.observations.size(), 0.0);
  std::vector<double> depths;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (views[i].empty()) continue;
    const TriangulationResult point = triangulate(camera_, first_.observations[i].bearing, views[i]);
    if (!point.converged || point.inverse_depth <= 0 || point.sigma > 0.5 * point.inverse_depth) continue;
    structure.inverse_depths[i] = point.inverse_depth;
    depths.push_back(point.inverse_depth);
  }
  if (depths.size() < 20) return structure;
  const double scale = median(depths);
  for (double& inverse_depth : structure.inverse_depths)
    inverse_depth = inverse_depth > 0 ? inverse_depth / scale : 1.0;
  for (Pose& pose : structure.first_T_camera) pose.translation *= scale;
  return adjust(std::move(structure));
}

std::vector<std::size_t> Initialisation::chooseFrames() const {
  std::vector<std::size_t> chosen;
  const auto count = static_cast<std::size_t>(options_.frames_between) + 1;
  for (std::size_t k = 1; k <= count; ++k) {
    const std::size_t frame = frames_.size() * k / count;
    if (frame >= 1 && (chosen.empty() || chosen.back() != frame - 1)) chosen.push_back(frame - 1);
  }
  return chosen;
}

}  // namespace edgeslam
