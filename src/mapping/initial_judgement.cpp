#include "mapping/initial_judgement.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "geometry/angles.h"
#include "geometry/median.h"
#include "geometry/relative_rotation.h"
#include "mapping/points_seen_by_both.h"

namespace edgeslam {
namespace {

// Two digits behind the point.
std::string shortNumber(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.2f", value);
  return text;
}

}  // namespace

double displacementLessRotation(const Camera& camera, const InitialFrames& frames) {
  constexpr std::size_t fewest_common = 8;
  const CommonBearings bearings = commonBearings(frames.first, frames.current());
  if (bearings.in_first.size() < fewest_common) return 0;
  return relativeRotation(bearings.in_first, bearings.in_other).median_error * meanFocalLength(camera);
}

double leastDisplacement(const Camera& camera, const InitialFrames& frames, const InitialisationOptions& options) {
  const bool is_first_map = frames.first.keyframe == 0;
  if (!is_first_map || cornersSeen(frames) < options.five_point_corners) return options.least_displacement_px;
  return std::min(options.least_displacement_px, radians(options.least_displacement_deg) * meanFocalLength(camera));
}

InitialEvidence judgeInitialStructure(const InitialFrames& frames, const InitialStructure& structure,
                                      const InitialisationOptions& options) {
  constexpr double degrees_a_radian = 180.0 / M_PI;
  assert(!structure.first_T_camera.empty());
  InitialEvidence evidence;
  evidence.frames = static_cast<int>(frames.since.size());
  std::vector<QualityPoint> quality_points;
  std::vector<double> angles_deg;
  const Eigen::Vector3d current_centre = structure.first_T_camera.back().translation;
  forEachCommon(frames.first, frames.current(), [&](std::size_t i, std::size_t) {
    ++evidence.followed;
    if (!structure.isKnown(i, options.largest_depth_sigma)) return;
    ++evidence.points;
    const PointObservation& first = frames.first.observations[i];
    const double inverse_depth = structure.inverse_depths[i];
    const Eigen::Vector3d ray = first.bearing / inverse_depth - current_centre;
    angles_deg.push_back(std::acos(std::clamp(ray.normalized().dot(first.bearing), -1.0, 1.0)) * degrees_a_radian);
    quality_points.push_back({first.measurement.pixel, first.measurement.normal, first.bearing, inverse_depth,
                              structure.depth_sigmas[i], first.chain, first.order});
  });
  evidence.parallax_deg = angles_deg.empty() ? 0 : upperMedian(angles_deg);
  evidence.quality = qualityFactor(std::move(quality_points), options.quality);
  return evidence;
}

std::string reasonToWait(const InitialEvidence& evidence, const InitialisationOptions& options) {
  if (evidence.parallax_deg < options.least_parallax_deg) {
    return "too little parallax (" + shortNumber(evidence.parallax_deg) + " deg)";
  }
  const bool is_early = evidence.frames < options.attempt_interval;
  const double of_those_followed = std::min<double>(options.fewest_points, options.point_share * evidence.followed);
  const double enough = is_early ? std::max<double>(options.early_points, of_those_followed) : of_those_followed;
  if (evidence.points < enough) return "too few points with a good depth (" + std::to_string(evidence.points) + ")";
  if (evidence.quality.share() < (is_early ? options.early_quality : options.least_quality)) {
    return "quality too low (" + std::to_string(evidence.quality.kept) + " of " +
           std::to_string(evidence.quality.pieces) + " edge pieces hold)";
  }
  return "";
}

std::string inWords(const InitialEvidence& evidence) {
  return "quality " + std::to_string(evidence.quality.kept) + " of " + std::to_string(evidence.quality.pieces) +
         " edge pieces, parallax " + shortNumber(evidence.parallax_deg) + " deg, " + std::to_string(evidence.points) +
         " points";
}

}  // namespace edgeslam
