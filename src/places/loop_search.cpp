#include "places/loop_search.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include "files/format_text.h"
#include "places/thumbnail.h"
#include "tracking/measured_noise.h"

namespace edgeslam {
namespace {

constexpr double degree = M_PI / 180;

// The points around the candidate that the current side does not see: what it sees says nothing about the loop.
std::vector<PointId> pointsOfOldSide(const Map& map, KeyframeId current, KeyframeId candidate, int neighbours) {
  const std::vector<PointId> there = pointsAround(map, candidate, neighbours);
  const std::vector<PointId> here = pointsAround(map, current, neighbours);
  std::vector<PointId> old_side;
  std::set_difference(there.begin(), there.end(), here.begin(), here.end(), std::back_inserter(old_side));
  return old_side;
}

// A keyframe of the current side, located on the old one.
struct Located {
  GuidedSearchResult search;  // not accepted: nearly, by too few points
  Similarity keyframe_S_candidate;
  std::vector<LoopVerification::Found> found;
};

class LoopSearch {
 public:
  LoopSearch(const Camera& camera, const ImageReading& reading, const Map& map, KeyframeId current,
             KeyframeId candidate, const LoopSearchOptions& options)
      : camera_(camera),
        reading_(reading),
        map_(map),
        candidate_(candidate),
        options_(options),
        search_(options.search),
        points_(pointsOfOldSide(map, current, candidate, options.search.neighbours)) {
    // Not even many corners tell a place from its like: what is asked of bare scenes is asked of all.
    search_.telling_corners = search_.many_corners = std::numeric_limits<int>::max();
    near_search_ = search_;
    near_search_.bare_inlier_share = options.near_share;
    near_search_.bare_corner_share = 0;
  }

  std::vector<Pose> starts(KeyframeId keyframe, const std::optional<Similarity>& rough) const;
  // Empty, with the reason, where it is not found on the old side, not even nearly, or the scale stays unknown. With a
  // reason too where it is found nearly.
  std::optional<Located> locate(KeyframeId keyframe, const std::vector<Pose>& starts, std::string& reason) const;
  // What the similarity of another keyframe says of this one, and where that puts it on the old side.
  Similarity carried(KeyframeId keyframe, KeyframeId other, const Similarity& other_S_candidate) const;
  Pose predicted(KeyframeId keyframe, KeyframeId other, const Similarity& other_S_candidate) const;

 private:
  bool isNear(const GuidedSearchResult& search) const {
    return search.evidence.corner_inliers >= options_.near_corners &&
           reasonToRefuse(search.evidence, near_search_).empty();
  }
  // Where most of the old side is found; the reason says why not enough of it is.
  std::optional<GuidedSearchResult> find(KeyframeId keyframe, const std::vector<Pose>& starts,
                                         std::string& reason) const;
  // Fills the similarity and what was found; false where the scale stays unknown.
  bool tellScale(KeyframeId keyframe, Located& located, std::string& reason) const;
  ScalePairs pairsOf(KeyframeId keyframe, const GuidedSearchResult& search,
                     std::vector<LoopVerification::Found>& found) const;

  const Camera& camera_;
  const ImageReading& reading_;
  const Map& map_;
  KeyframeId candidate_;
  const LoopSearchOptions& options_;
  GuidedSearchOptions search_, near_search_;
  std::vector<PointId> points_;
};

// As if the camera had only turned since the candidate, or had moved on or back by a share of the scene's distance too.
std::vector<Pose> LoopSearch::starts(KeyframeId keyframe, const std::optional<Similarity>& rough) const {
  const Keyframe& there = map_.keyframes[candidate_];
  std::vector<Pose> poses;
  const auto add = [&](const Pose& candidate_T_start) { poses.push_back(there.world_T_camera * candidate_T_start); };
  if (rough) add(upToScale(*rough).inverse());
  const auto thumbnailOf = [&](const Keyframe& k) { return makeThumbnail(k.images->pyramid, camera_.mask.get()); };
  const ThumbnailMatch match = matchTurned(thumbnailOf(there), thumbnailOf(map_.keyframes[keyframe]));
  if (match.correlation < options_.least_correlation) return poses;
  const double distance = sceneDistance(map_, there);
  if (distance == 0) return poses;
  const Eigen::Quaterniond turn = rotationOf(camera_, match);
  for (const double forward : {0.0, 0.15, -0.15, 0.3, -0.3, 0.45, -0.45}) add({turn, {0, 0, forward * distance}});
  return poses;
}

std::optional<GuidedSearchResult> LoopSearch::find(KeyframeId keyframe, const std::vector<Pose>& starts,
                                                   std::string& reason) const {
  const Keyframe& here = map_.keyframes[keyframe];
  const std::shared_ptr<const FrameImages> images = here.images.get();
  const cv::Mat& grey = images->pyramid.levels[0];
  const CameraMask* mask = camera_.mask.get();
  const EdgeMap edges = detectEdges(grey, reading_.edges, mask);
  SearchedFrame frame{*images, edges, accuracyIn(grey, reading_.accuracy, mask)};
  frame.accuracy.noise_factor = noiseFactorOf(here, reading_.accuracy);
  std::vector<ScreenedPose> screened;
  for (const Pose& start : starts) {
    ScreenedPose look = screenPose(camera_, map_, points_, frame, start, search_);
    if (look.evidence.share() >= options_.screened_share) screened.push_back(std::move(look));
  }
  std::stable_sort(screened.begin(), screened.end(), [](const ScreenedPose& a, const ScreenedPose& b) {
    return a.evidence.share() > b.evidence.share();
  });
  if (static_cast<int>(screened.size()) > options_.refined_poses)
    screened.resize(static_cast<std::size_t>(options_.refined_poses));
  std::optional<GuidedSearchResult> best;
  reason = "no pose shows the old side";
  for (const ScreenedPose& look : screened) {
    GuidedSearchResult search = guidedSearch(camera_, map_, points_, frame, look.world_T_camera, search_);
    const double shares = search.evidence.share() + search.evidence.explained;
    if (search.accepted && shares < options_.found_and_explained) {
      search.accepted = false;
      search.reason = formatted("%.0f %% of the points found, %.0f %% of the edges explained",
                                100 * search.evidence.share(), 100 * search.evidence.explained);
    }
    if (!search.accepted && !(best && best->accepted)) reason = search.reason;
    if (!search.accepted && !isNear(search)) continue;
    if (!best ||
        std::pair(best->accepted, best->evidence.share()) < std::pair(search.accepted, search.evidence.share()))
      best = std::move(search);
  }
  return best;
}

std::optional<Located> LoopSearch::locate(KeyframeId keyframe, const std::vector<Pose>& starts,
                                          std::string& reason) const {
  std::optional<GuidedSearchResult> search = find(keyframe, starts, reason);
  if (!search) return std::nullopt;
  Located located;
  located.search = std::move(*search);
  std::string of_scale;
  const bool is_known = tellScale(keyframe, located, of_scale);
  if (located.search.accepted) reason = std::move(of_scale);
  if (!is_known) return std::nullopt;
  return located;
}

bool LoopSearch::tellScale(KeyframeId keyframe, Located& located, std::string& reason) const {
  const GuidedSearchResult& search = located.search;
  const double agreeing_share = search.accepted ? options_.agreeing_share : options_.near_agreeing_share;
  const ScalePairs pairs = pairsOf(keyframe, search, located.found);
  const ScaleEstimate scale = estimateScale(pairs);
  if (static_cast<int>(pairs.log_ratios.size()) < options_.fewest_pairs) {
    reason = formatted("%zu points on both sides, %d needed", pairs.log_ratios.size(), options_.fewest_pairs);
    return false;
  }
  if (scale.agreeing_share < agreeing_share) {
    reason = formatted("%.0f %% of the depths agree", 100 * scale.agreeing_share);
    return false;
  }
  if (!(scale.deviation < options_.scale_deviation)) {
    reason = formatted("scale known to %.0f %%", 100 * scale.deviation);
    return false;
  }
  const Pose keyframe_T_candidate = search.pose.world_T_camera.inverse() * map_.keyframes[candidate_].world_T_camera;
  const double ratio = std::exp(scale.log_scale);
  located.keyframe_S_candidate = {ratio, keyframe_T_candidate.rotation, ratio * keyframe_T_candidate.translation};
  reason = formatted("%d of %d points, %.0f %% explained, scale %.3f +- %.3f from %zu", search.evidence.inliers,
                     search.evidence.visible, 100 * search.evidence.explained, ratio, scale.deviation,
                     pairs.log_ratios.size());
  return true;
}

ScalePairs LoopSearch::pairsOf(KeyframeId keyframe, const GuidedSearchResult& search,
                               std::vector<LoopVerification::Found>& found) const {
  const PlaceView here = placeView(camera_, map_, keyframe, options_.scale_neighbours);
  ScalePairs pairs;
  for (const MatchedPoint& match : search.inliers) {
    LoopVerification::Found entry;
    entry.candidate_point = match.point;
    entry.measurement = match.measurement;
    const MapPoint& old_point = map_.points.at(match.point);
    const PlacePoint* partner = nullptr;
    double least = options_.pair_along;
    for (const PlacePoint& point : here.points) {
      const Eigen::Vector2d apart = point.measurement.pixel - match.measurement.pixel;
      if (std::abs(apart.dot(match.measurement.normal)) > options_.pair_across ||
          point.measurement.normal.dot(match.measurement.normal) < options_.pair_dot || !(apart.norm() < least)) {
        continue;
      }
      least = apart.norm();
      partner = &point;
    }
    if (partner) {
      entry.current_point = partner->id;
      const double distance = (worldPosition(map_, old_point) - search.pose.world_T_camera.translation).norm();
      pairs.log_ratios.push_back(std::log(partner->position.norm() / distance));
      pairs.deviations.push_back(std::hypot(
          partner->depth_deviation, old_point.inverse_depth_sigma / old_point.inverse_depth, options_.depth_deviation));
    }
    found.push_back(entry);
  }
  return pairs;
}

Similarity LoopSearch::carried(KeyframeId keyframe, KeyframeId other, const Similarity& other_S_candidate) const {
  const Pose keyframe_T_other =
      map_.keyframes[keyframe].world_T_camera.inverse() * map_.keyframes[other].world_T_camera;
  return Similarity{1, keyframe_T_other.rotation, keyframe_T_other.translation} * other_S_candidate;
}

Pose LoopSearch::predicted(KeyframeId keyframe, KeyframeId other, const Similarity& other_S_candidate) const {
  return map_.keyframes[candidate_].world_T_camera * upToScale(carried(keyframe, other, other_S_candidate)).inverse();
}

}  // namespace

ScaleEstimate estimateScale(const ScalePairs& pairs) {
  ScaleEstimate estimate;
  estimate.deviation = std::numeric_limits<double>::infinity();
  if (pairs.log_ratios.empty()) return estimate;
  std::vector<double> sorted = pairs.log_ratios;
  std::sort(sorted.begin(), sorted.end());
  estimate.log_scale = sorted[sorted.size() / 2];
  double weights = 0, squares = 0;
  std::size_t agreeing = 0;
  for (int round = 0; round < 10; ++round) {
    double sum = 0;
    weights = squares = 0;
    agreeing = 0;
    for (std::size_t i = 0; i < pairs.log_ratios.size(); ++i) {
      const double error = (pairs.log_ratios[i] - estimate.log_scale) / pairs.deviations[i];
      if (std::abs(error) > 3) continue;
      ++agreeing;
      const double weight = 1 / (pairs.deviations[i] * pairs.deviations[i]);
      sum += weight * pairs.log_ratios[i];
      weights += weight;
      squares += error * error;
    }
    if (agreeing == 0) return estimate;
    estimate.log_scale = sum / weights;
  }
  estimate.agreeing_share = static_cast<double>(agreeing) / static_cast<double>(pairs.log_ratios.size());
  estimate.deviation = std::sqrt(std::max(1.0, squares / static_cast<double>(agreeing)) / weights);
  return estimate;
}

LoopVerification verifyLoopBySearch(const Camera& camera, const ImageReading& reading, const Map& map,
                                    KeyframeId current, KeyframeId candidate, const LoopVerification& descriptors,
                                    const LoopSearchOptions& options) {
  LoopVerification result = descriptors;
  result.accepted = false;
  const LoopSearch search(camera, reading, map, current, candidate, options);
  std::optional<Similarity> rough;
  if (descriptors.inliers >= options.fewest_rough_inliers) rough = descriptors.current_S_candidate;
  const std::optional<Located> here = search.locate(current, search.starts(current, rough), result.reason);
  if (!here || (!here->search.accepted && descriptors.accepted)) return result;
  result.nearly_found = !here->search.accepted;
  result.current_S_candidate = here->keyframe_S_candidate;
  result.found = here->found;
  result.inliers = here->search.evidence.inliers;
  result.found_share = here->search.evidence.share();
  result.corner_inliers = here->search.evidence.corner_inliers;
  if (result.nearly_found) return result;

  // What another keyframe, or the descriptors, say of the current one must be the same.
  const auto contradicts = [&](const Similarity& current_S_candidate) {
    const Pose says = upToScale(current_S_candidate), found = upToScale(here->keyframe_S_candidate);
    const double turn = rotationAngle(says.rotation, found.rotation);
    const double apart =
        (says.inverse().translation - found.inverse().translation).norm() / here->search.evidence.median_distance;
    const double scale = std::abs(std::log(current_S_candidate.scale / here->keyframe_S_candidate.scale));
    return turn > options.witness_turn_deg * degree || apart > options.witness_distance ||
           scale > options.witness_scale;
  };
  int witnesses = 0;
  if (descriptors.accepted) {
    if (contradicts(descriptors.current_S_candidate)) {
      result.reason += "; the descriptors contradict";
      return result;
    }
    witnesses += options.descriptors_count;
  }
  const std::size_t place = map.keyframes.placeOf(current);
  for (std::size_t back = 1; back <= static_cast<std::size_t>(options.witnesses) && back <= place; ++back) {
    if (witnesses >= options.fewest_witnesses) break;
    const Keyframe& keyframe = map.keyframes.atPlace(place - back);
    if (!keyframe.images) continue;
    std::string reason;
    const std::optional<Located> witness =
        search.locate(keyframe.id, {search.predicted(keyframe.id, current, here->keyframe_S_candidate)}, reason);
    if (!witness || !witness->search.accepted) continue;
    if (contradicts(search.carried(current, keyframe.id, witness->keyframe_S_candidate))) {
      result.reason += formatted("; keyframe %d contradicts", keyframe.id);
      return result;
    }
    ++witnesses;
  }
  result.accepted = witnesses >= options.fewest_witnesses;
  result.reason += formatted("; %d of %d witnesses", witnesses, options.fewest_witnesses);
  return result;
}

}  // namespace edgeslam
