#include "mapping/initialisation.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "adjustment/pose_adjustment.h"
#include "geometry/relative_rotation.h"
#include "mapping/points_seen_by_both.h"

namespace edgeslam {
namespace {

constexpr double degrees = 180.0 / M_PI;

std::string shortNumber(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.2f", value);
  return text;
}

}  // namespace

void Initialisation::start(const TrackedFrame& first) {
  first_ = first;
  frames_.clear();
  inverse_depths_.assign(first.observations.size(), 1.0);
  depth_sigmas_.assign(first.observations.size(), flat_start_sigma);
  accepted_ = InitialStructure();
  waiting_for_ = "motion of the camera";
  changed_ = false;
}

bool Initialisation::add(const TrackedFrame& frame) {
  changed_ = false;
  frames_.push_back(frame);
  if (frames_.size() > 400) {  // a camera that hardly moves: every second frame is enough
    std::vector<TrackedFrame> thinned;
    for (std::size_t i = 1; i < frames_.size(); i += 2) thinned.push_back(std::move(frames_[i]));
    frames_ = std::move(thinned);
  }
  if (frames_.size() % static_cast<std::size_t>(options_.attempt_interval) != 0) return false;
  if (displacementLessRotation() < options_.least_displacement_px) {
    waiting_for_ = "too little parallax: the points hardly moved, or by rotation only";
    return false;
  }
  return attempt();
}

bool Initialisation::attempt() {
  InitialStructure best = followedStart();
  if (reasonToWait(best).empty()) {
    // A structure of lines can stand wrong and look well: before it is believed, others from quite different starts
    // must fit the same measurements worse. Most of them fall into the same solution where that is the right one.
    for (InitialStructure& rival : rivals()) {
      if (rival.usable && (!best.usable || rival.error < best.error)) best = std::move(rival);
    }
  }
  if (best.usable) {
    inverse_depths_ = best.inverse_depths;
    depth_sigmas_ = best.depth_sigmas;
    for (std::size_t i = 0; i < best.frames.size(); ++i)
      frames_[best.frames[i]].world_T_camera = best.first_T_camera[i];
    changed_ = true;
  }
  waiting_for_ = reasonToWait(best);
  if (!waiting_for_.empty()) return false;
  accepted_ = std::move(best);
  description_ = accepted_.method + " from frame " + std::to_string(first_.frame_index) + " to frame " +
                 std::to_string(frames_.back().frame_index) + ", quality " + std::to_string(accepted_.quality.kept) +
                 " of " + std::to_string(accepted_.quality.pieces) + " edge pieces, parallax " +
                 shortNumber(accepted_.parallax_deg) + " deg, " + std::to_string(accepted_.points) + " points";
  return true;
}

std::string Initialisation::reasonToWait(const InitialStructure& structure) const {
  if (!structure.usable) return "the adjustment of the first frames failed";
  if (structure.parallax_deg < options_.least_parallax_deg) {
    return "too little parallax (" + shortNumber(structure.parallax_deg) + " deg)";
  }
  const double enough = std::min<double>(options_.fewest_points, options_.point_share * structure.followed);
  if (structure.points < enough) return "too few points with a good depth (" + std::to_string(structure.points) + ")";
  if (structure.quality.share() < options_.least_quality) {
    return "quality too low (" + std::to_string(structure.quality.kept) + " of " +
           std::to_string(structure.quality.pieces) + " edge pieces hold)";
  }
  return "";
}

InitialStructure Initialisation::adjust(InitialStructure structure) const {
  BundleProblem problem;
  problem.cameras.push_back({Pose(), true});
  for (const Pose& pose : structure.first_T_camera) problem.cameras.push_back({pose, false});
  for (std::size_t i = 0; i < first_.observations.size(); ++i) {
    BundlePoint point;
    point.host_bearing = first_.observations[i].bearing;
    point.inverse_depth = structure.inverse_depths[i] > 0 ? structure.inverse_depths[i] : 1.0;
    point.prior_sigma = options_.prior_sigma;
    problem.points.push_back(point);
  }
  for (std::size_t k = 0; k < structure.frames.size(); ++k) {
    const TrackedFrame& frame = frames_[structure.frames[k]];
    forEachCommon(first_, frame, [&](std::size_t i, std::size_t j) {
      problem.observations.push_back({static_cast<int>(k) + 1, static_cast<int>(i), frame.observations[j].measurement});
    });
  }
  BundleResult result = adjustBundle(camera_, problem, options_.bundle);
  if (!result.usable) return structure;

  // A second round without the outliers: sliding points would bend the start.
  BundleProblem inliers = problem;
  inliers.observations.clear();
  for (std::size_t k = 0; k < problem.observations.size(); ++k) {
    if (result.errors[k] < options_.outlier) inliers.observations.push_back(problem.observations[k]);
  }
  result = adjustBundle(camera_, inliers, options_.bundle);
  if (!result.usable) return structure;

  for (std::size_t k = 0; k < structure.frames.size(); ++k)
    structure.first_T_camera[k] = inliers.cameras[k + 1].world_T_camera;
  structure.depth_sigmas = result.depth_sigmas;
  structure.error = boundedError(inliers, problem.observations);
  std::vector<int> seen(first_.observations.size(), 0);
  for (std::size_t k = 0; k < inliers.observations.size(); ++k) {
    if (result.errors[k] < options_.outlier) ++seen[static_cast<std::size_t>(inliers.observations[k].point)];
  }
  for (std::size_t i = 0; i < inliers.points.size(); ++i) {
    structure.inverse_depths[i] = inliers.points[i].inverse_depth;
    if (seen[i] == 0) structure.depth_sigmas[i] = options_.prior_sigma;
  }
  structure.usable = true;
  judge(structure);
  return structure;
}

// Of all observations, also those that the adjustment left out: it must not look good by having many outliers.
double Initialisation::boundedError(const BundleProblem& adjusted,
                                    const std::vector<BundleObservation>& observations) const {
  const double bound = options_.outlier * options_.outlier;
  double sum = 0;
  for (const BundleObservation& observation : observations) {
    const BundlePoint& point = adjusted.points[static_cast<std::size_t>(observation.point)];
    const Pose camera_T_first = adjusted.cameras[static_cast<std::size_t>(observation.camera)].world_T_camera.inverse();
    const Eigen::Vector3d seen =
        camera_T_first.rotation * point.host_bearing + point.inverse_depth * camera_T_first.translation;
    if (!(seen.z() > 0)) {
      sum += bound;
      continue;
    }
    const Measurement& measurement = observation.measurement;
    sum += std::min(bound, (whitening(measurement) * (project(camera_, seen) - measurement.pixel)).squaredNorm());
  }
  return sum / std::max<double>(1, static_cast<double>(observations.size()));
}

void Initialisation::judge(InitialStructure& structure) const {
  const TrackedFrame& current = frames_.back();
  std::vector<QualityPoint> quality_points;
  std::vector<double> angles;
  forEachCommon(first_, current, [&](std::size_t i, std::size_t) {
    ++structure.followed;
    const PointObservation& first = first_.observations[i];
    const double inverse_depth = structure.inverse_depths[i], sigma = structure.depth_sigmas[i];
    if (inverse_depth <= 0 || sigma > options_.largest_depth_sigma * inverse_depth) return;
    ++structure.points;
    const Eigen::Vector3d ray = first.bearing / inverse_depth - structure.first_T_camera.back().translation;
    angles.push_back(std::acos(std::clamp(ray.normalized().dot(first.bearing), -1.0, 1.0)) * degrees);
    quality_points.push_back({first.measurement.pixel, first.measurement.normal, first.bearing, inverse_depth, sigma,
                              first.chain, first.order});
  });
  structure.parallax_deg = median(std::move(angles));
  structure.quality = qualityFactor(std::move(quality_points), options_.quality);
}

double Initialisation::displacementLessRotation() const {
  std::vector<Eigen::Vector3d> first, current;
  forEachCommon(first_, frames_.back(), [&](std::size_t i, std::size_t j) {
    first.push_back(first_.observations[i].bearing);
    current.push_back(frames_.back().observations[j].bearing);
  });
  if (first.size() < 8) return 0;
  return relativeRotation(first, current).median_error * meanFocalLength(camera_);
}

void Initialisation::writeProvisional(MapView& view) const {
  view = flatView(first_);
  for (std::size_t i = 0; i < view.points.size(); ++i) {
    view.points[i].inverse_depth = inverse_depths_[i];
    view.points[i].inverse_depth_sigma = depth_sigmas_[i];
  }
}

Map Initialisation::map() const {
  Map map;
  const auto addKeyframe = [&](const TrackedFrame& frame, const Pose& pose, const char* reason) {
    Keyframe keyframe;
    keyframe.id = static_cast<KeyframeId>(map.keyframes.size());
    keyframe.frame_index = frame.frame_index;
    keyframe.time_ns = frame.time_ns;
    keyframe.world_T_camera = pose;
    keyframe.observations = frame.observations;
    keyframe.images = frame.images;
    keyframe.reason = reason;
    map.keyframes.push_back(std::move(keyframe));
  };
  addKeyframe(first_, Pose(), "first");
  for (std::size_t k = 0; k < accepted_.frames.size(); ++k) {
    addKeyframe(frames_[accepted_.frames[k]], accepted_.first_T_camera[k], "initialisation");
  }
  for (std::size_t i = 0; i < first_.observations.size(); ++i) {
    const PointObservation& first = first_.observations[i];
    const double inverse_depth = accepted_.inverse_depths[i], sigma = accepted_.depth_sigmas[i];
    if (inverse_depth <= 0 || sigma > options_.largest_depth_sigma * inverse_depth) continue;
    MapPoint point;
    point.id = first.point;
    point.host_bearing = first.bearing;
    point.inverse_depth = inverse_depth;
    point.inverse_depth_sigma = sigma;
    point.corner = first.corner;
    point.chain = first.chain;
    point.order = first.order;
    for (const Keyframe& keyframe : map.keyframes) {
      if (keyframe.id > 0 && findObservation(keyframe, point.id)) point.seen_in.push_back(keyframe.id);
    }
    if (!point.seen_in.empty()) map.points.emplace(point.id, point);
  }
  return map;
}

std::optional<Pose> Initialisation::locate(const TrackedFrame& frame, const Pose& near) const {
  PoseObservations observations;
  forEachCommon(first_, frame, [&](std::size_t i, std::size_t j) {
    if (accepted_.inverse_depths[i] <= 0) return;
    PoseObservation observation;
    observation.point = first_.observations[i].bearing / accepted_.inverse_depths[i];
    observation.measurement = frame.observations[j].measurement;
    observations.push_back(observation);
  });
  const PoseResult result = adjustPose(camera_, near, observations, PoseOptions());
  if (!result.converged) return std::nullopt;
  return result.world_T_camera;
}

std::vector<std::pair<std::int64_t, Pose>> Initialisation::earlyPoses() const {
  std::vector<std::pair<std::int64_t, Pose>> poses{{first_.frame_index, Pose()}};
  // Backwards from the last frame, whose pose is known: each starts from its successor.
  Pose pose = accepted_.first_T_camera.empty() ? Pose() : accepted_.first_T_camera.back();
  for (std::size_t frame = frames_.size(); frame-- > 0;) {
    const std::optional<Pose> located = locate(frames_[frame], pose);
    if (!located) break;
    pose = *located;
    poses.emplace_back(frames_[frame].frame_index, pose);
  }
  std::sort(poses.begin(), poses.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  return poses;
}

}  // namespace edgeslam
