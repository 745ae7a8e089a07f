#include "places/loop_verification.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "files/format_text.h"
#include "places/loop_search.h"
#include "places/similarity_estimation.h"
#include "tracking/measured_noise.h"

namespace edgeslam {
namespace {

// Of a descriptor's match: its place is only as good as the point next to it is near.
constexpr double descriptor_across = 2.5;  // [px]
constexpr double descriptor_along = 6;     // [px]

Measurement loosened(Measurement m, double across, double along) {
  m.sigma_normal = std::hypot(m.sigma_normal, across);
  m.sigma_tangent = std::hypot(m.sigma_tangent, along);
  return m;
}

double depthDeviation(const PlacePoint& a, const PlacePoint& b, double floor) {
  return std::sqrt(a.depth_deviation * a.depth_deviation + b.depth_deviation * b.depth_deviation + floor * floor);
}

const PlacePoint& pointAt(const PlaceView& view, int index) { return view.points[static_cast<std::size_t>(index)]; }

std::vector<PlaceCorrespondence> descriptorPairs(const Map& map, const PlaceView& current, const PlaceView& candidate,
                                                 const LoopVerificationOptions& options) {
  const auto poseOf = [&](const PlaceView& view) { return map.keyframes[view.keyframe].world_T_camera; };
  std::vector<PlaceCorrespondence> pairs;
  for (const auto& [i, j] :
       matchKeyframes(current, candidate, poseOf(current).inverse() * poseOf(candidate), options.matching)) {
    const PlacePoint& here = pointAt(current, i);
    const PlacePoint& there = pointAt(candidate, j);
    PlaceCorrespondence pair;
    pair.paired = true;
    pair.candidate_point = there.position;
    pair.current_point = here.position;
    pair.in_current = loosened(here.measurement, descriptor_across, descriptor_along);
    pair.in_candidate = loosened(there.measurement, descriptor_across, descriptor_along);
    // Whichever way the edge runs, a descriptor's match is that of a place.
    pair.in_current.sigma_tangent = std::min(pair.in_current.sigma_tangent, descriptor_along);
    pair.in_candidate.sigma_tangent = std::min(pair.in_candidate.sigma_tangent, descriptor_along);
    pair.depth_deviation = depthDeviation(here, there, 2 * options.depth_error);
    pairs.push_back(pair);
  }
  return pairs;
}

std::vector<PlaceCorrespondence> guidedPairs(const GuidedMatches& guided, const PlaceView& current,
                                             const PlaceView& candidate, const LoopVerificationOptions& options) {
  std::vector<PlaceCorrespondence> pairs;
  for (const GuidedMatch& match : guided.matches) {
    const PlacePoint& there = pointAt(candidate, match.from);
    PlaceCorrespondence pair;
    pair.candidate_point = there.position;
    pair.in_current = loosened(match.measurement, options.map_error, options.map_error);
    if (match.to >= 0) {
      const PlacePoint& here = pointAt(current, match.to);
      pair.paired = true;
      pair.current_point = here.position;
      // The counterpart is on the same edge, somewhere near.
      pair.in_candidate = loosened(there.measurement, options.map_error + 0.5, options.guided.partner_along);
      pair.depth_deviation = depthDeviation(here, there, options.depth_error);
    }
    pairs.push_back(pair);
  }
  return pairs;
}

int cellsWithInliers(const Camera& camera, const std::vector<PlaceCorrespondence>& pairs,
                     const std::vector<char>& inliers) {
  std::set<int> cells;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!inliers[i]) continue;
    const Eigen::Vector2d& pixel = pairs[i].in_current.pixel;
    const int column = std::clamp(static_cast<int>(4 * pixel.x() / camera.width), 0, 3);
    const int row = std::clamp(static_cast<int>(4 * pixel.y() / camera.height), 0, 3);
    cells.insert(4 * row + column);
  }
  return static_cast<int>(cells.size());
}

// What the current side sees too says where the map has it, not where it is.
void keepOldSide(const Map& map, KeyframeId current, int neighbours, PlaceView& there) {
  const std::vector<PointId> seen_here = pointsAround(map, current, neighbours);
  there.points.erase(std::remove_if(there.points.begin(), there.points.end(),
                                    [&](const PlacePoint& point) {
                                      return std::binary_search(seen_here.begin(), seen_here.end(), point.id);
                                    }),
                     there.points.end());
}

// A camera that errs more makes rougher maps.
LoopVerificationOptions withNoise(LoopVerificationOptions options, double noise_factor) {
  options.map_error *= noise_factor;
  options.largest_move *= noise_factor;
  options.search.pair_across *= noise_factor;
  return options;
}

LoopVerification verifyByDescriptors(const Camera& camera, const Map& map, KeyframeId current, KeyframeId candidate,
                                     const LoopVerificationOptions& options, std::uint64_t seed) {
  LoopVerification result;
  const PlaceView here = placeView(camera, map, current, options.neighbours);
  PlaceView there = placeView(camera, map, candidate, options.neighbours);
  keepOldSide(map, current, options.neighbours, there);
  const std::vector<PlaceCorrespondence> described = descriptorPairs(map, here, there, options);
  result.descriptor_pairs = static_cast<int>(described.size());
  const SimilarityEstimate first = estimateSimilarity(
      camera, described, options.outlier, options.fewest_descriptor_inliers, options.ransac_iterations, seed);
  result.descriptor_inliers = first.inlier_count;
  result.inliers = first.inlier_count;
  result.current_S_candidate = first.current_S_candidate;
  if (!first.found) {
    result.reason = formatted("descriptors: %d of %d agree, %d needed", first.inlier_count, result.descriptor_pairs,
                              options.fewest_descriptor_inliers);
    return result;
  }
  result.inliers = 0;

  // Patches, twice: what the first round finds makes the prediction good enough for a narrow search.
  GuidedMatches guided;
  std::vector<PlaceCorrespondence> pairs;
  for (const double largest_move : {2 * options.largest_move, options.largest_move}) {
    guided = matchGuided(camera, map, there, here, result.current_S_candidate, largest_move, options.guided);
    pairs = guidedPairs(guided, here, there, options);
    result.current_S_candidate = refineSimilarity(camera, pairs, result.current_S_candidate, options.outlier / 2, 20);
  }

  std::vector<char> inliers(pairs.size(), 0);
  int agreeing = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!(correspondenceError(camera, pairs[i], result.current_S_candidate) < options.outlier)) continue;
    inliers[i] = 1;
    ++agreeing;
    if (pairs[i].paired) ++result.inliers;
    const GuidedMatch& match = guided.matches[i];
    LoopVerification::Found found;
    found.candidate_point = pointAt(there, match.from).id;
    if (match.to >= 0) found.current_point = pointAt(here, match.to).id;
    found.measurement = match.measurement;
    result.found.push_back(found);
  }
  result.found_share = guided.visible > 0 ? static_cast<double>(agreeing) / guided.visible : 0;
  result.needed_inliers =
      std::clamp(static_cast<int>(std::ceil(options.needed_share * guided.visible_in_both)),
                 options.fewest_needed_inliers, std::max(options.fewest_needed_inliers, options.most_needed_inliers));
  const int cells = cellsWithInliers(camera, pairs, inliers);
  const double scale = result.current_S_candidate.scale;

  if (result.inliers < result.needed_inliers) {
    result.reason = formatted("%d inliers, %d needed", result.inliers, result.needed_inliers);
  } else if (result.found_share < options.least_found_share) {
    result.reason = formatted("%.0f %% of the points in view found, %.0f %% needed", 100 * result.found_share,
                              100 * options.least_found_share);
  } else if (cells < options.fewest_cells) {
    result.reason = formatted("inliers in %d of 16 parts of the image, %d needed", cells, options.fewest_cells);
  } else if (!(scale < options.largest_scale && scale > 1 / options.largest_scale)) {
    result.reason = formatted("a change of scale by %.2f", scale);
  } else {
    result.accepted = result.accepted_by_descriptors = true;
    result.reason = formatted("%d inliers of %d needed, %.0f %% of the points in view", result.inliers,
                              result.needed_inliers, 100 * result.found_share);
  }
  return result;
}

}  // namespace

LoopVerification verifyLoop(const Camera& camera, const ImageReading& reading, const Map& map, KeyframeId current,
                            KeyframeId candidate, const LoopVerificationOptions& presumed, std::uint64_t seed) {
  const double noise_factor = noiseFactorOf(map.keyframes[current], reading.accuracy);
  const LoopVerificationOptions options = withNoise(presumed, noise_factor);
  LoopVerification result;
  if (!map.keyframes[current].images || !map.keyframes[candidate].images) {
    result.reason = "a keyframe without images";
    return result;
  }
  const LoopVerification descriptors = verifyByDescriptors(camera, map, current, candidate, options, seed);
  result = verifyLoopBySearch(camera, reading, map, current, candidate, descriptors, options.search);
  const double scale = result.current_S_candidate.scale;
  if (result.accepted && !(scale < options.largest_scale && scale > 1 / options.largest_scale)) {
    result.accepted = false;
    result.reason = formatted("a change of scale by %.2f", scale);
  }
  result.reason = descriptors.reason + "; by search: " + result.reason;
  return result;
}

}  // namespace edgeslam
