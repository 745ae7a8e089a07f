#include "places/guided_search.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "geometry/angles.h"
#include "geometry/median.h"
#include "tracking/measurement_accuracy.h"

namespace edgeslam {
namespace {

// One round: how far is searched, and how much the accuracy that is asked of what was found is widened.
struct Round {
  double radius = 0;  // [px]
  int coarsest_level = 0;
  double widening = 1;
  int most_points = 0;
};

struct RoundResult {
  PoseResult pose;
  int visible = 0;
  int visible_corners = 0;
  std::vector<MatchedPoint> matches;  // as pose.inliers
  std::vector<double> distances;      // of the matches' points from the camera
};

// At most `count` of the points, corners before edges, evenly from the list.
VisiblePoints thinOut(const SearchPoints& points, const VisiblePoints& visible, int count) {
  if (static_cast<int>(visible.size()) <= count) return visible;
  VisiblePoints corners, others, chosen;
  for (const VisiblePoint& candidate : visible)
    (points[candidate.index].corner ? corners : others).push_back(candidate);
  const auto takeEvenly = [&](const VisiblePoints& from, std::size_t wanted) {
    wanted = std::min(wanted, from.size());
    for (std::size_t i = 0; i < wanted; ++i) chosen.push_back(from[i * from.size() / wanted]);
  };
  takeEvenly(corners, static_cast<std::size_t>(count) / 2);
  takeEvenly(others, static_cast<std::size_t>(count) - chosen.size());
  return chosen;
}

// To the visible points alone: of all those around a place the keyframes are many, and their images would be unpacked.
// The points are good for as long as what is returned is held.
std::vector<std::shared_ptr<const FrameImages>> giveImages(const Map& map, const std::vector<KeyframeId>& sources,
                                                           const VisiblePoints& visible, SearchPoints& points) {
  std::vector<std::shared_ptr<const FrameImages>> held;
  for (const VisiblePoint& candidate : visible) {
    held.push_back(map.keyframes[sources[candidate.index]].images.get());
    points[candidate.index].source_images = held.back().get();
  }
  return held;
}

Track accuracyAt(const SearchedFrame& frame, const FoundPoint& found) {
  Track track;
  track.pixel = found.pixel;
  track.normal = found.normal;
  updateAccuracy(frame.images.pyramid.levels[0], frame.accuracy, track);
  return track;
}

RoundResult searchOnce(const Camera& camera, const Map& map, const std::vector<PointId>& ids,
                       const SearchedFrame& frame, const Pose& start, const GuidedSearchOptions& options,
                       const Round& round) {
  MapSearchOptions search = options.search;
  search.radius = round.radius;
  search.coarsest_level = round.coarsest_level;
  std::vector<KeyframeId> sources;
  SearchPoints points = searchPoints(map, ids, start, sources);
  const VisiblePoints visible = thinOut(points, visiblePoints(camera, points, start, search), round.most_points);
  const std::vector<std::shared_ptr<const FrameImages>> held = giveImages(map, sources, visible, points);

  RoundResult result;
  result.visible = static_cast<int>(visible.size());
  for (const VisiblePoint& candidate : visible) result.visible_corners += points[candidate.index].corner ? 1 : 0;
  const Pose camera_T_world = start.inverse();
  PoseObservations observations;
  for (const FoundPoint& found : findVisiblePoints(points, visible, frame.images, frame.edges, search)) {
    const SearchPoint& point = points[found.index];
    const Track seen = accuracyAt(frame, found);
    // A corner must be one in both images to count as one.
    const bool corner = point.corner && seen.corner;
    Measurement measurement = corner ? measurementOf(point, found) : measurementOf(seen);
    if (!corner) {
      measurement.sigma_normal = sigmaAcross(/*corner=*/false, frame.accuracy);
      measurement.sigma_tangent = std::max<double>(seen.sigma_tangent, point.sigma_tangent);
    }
    result.matches.push_back({point.id, measurement, point.corner, sources[found.index]});
    result.distances.push_back((point.position - start.translation).norm());
    measurement.sigma_normal *= round.widening;
    measurement.sigma_tangent *= round.widening;
    const MapPoint& mapped = map.points.at(point.id);
    observations.push_back(observeWithDepth(camera, camera_T_world * map.keyframes[mapped.host].world_T_camera,
                                            {mapped.host_bearing, mapped.inverse_depth, mapped.inverse_depth_sigma},
                                            point.position, measurement));
  }
  result.pose = adjustPose(camera, start, observations, options.pose);
  return result;
}

int cellsCovered(const Camera& camera, const std::vector<MatchedPoint>& matches) {
  std::set<int> cells;
  for (const MatchedPoint& match : matches) {
    const auto column = static_cast<int>(4 * match.measurement.pixel.x() / camera.width);
    const auto row = static_cast<int>(4 * match.measurement.pixel.y() / camera.height);
    cells.insert(4 * std::clamp(row, 0, 3) + std::clamp(column, 0, 3));
  }
  return static_cast<int>(cells.size());
}

double largestSigma(const Eigen::Matrix3d& covariance) {
  return std::sqrt(std::max(0.0, Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvalues()[2]));
}

std::string of(int count, int all, const char* what) {
  return std::to_string(count) + " of " + std::to_string(all) + " " + what;
}

PoseEvidence countEvidence(const RoundResult& round) {
  PoseEvidence evidence;
  evidence.visible = round.visible;
  evidence.visible_corners = round.visible_corners;
  if (!round.pose.converged) return evidence;
  evidence.inliers = round.pose.inlier_count;
  for (std::size_t i = 0; i < round.matches.size(); ++i) {
    evidence.corner_inliers += round.pose.inliers[i] && round.matches[i].corner ? 1 : 0;
  }
  return evidence;
}

}  // namespace

std::vector<PointId> pointsAround(const Map& map, KeyframeId keyframe, int neighbours) {
  const std::vector<int> shared = sharedPoints(map, keyframe);
  std::vector<KeyframeId> order;
  for (KeyframeId k = 0; k < static_cast<KeyframeId>(shared.size()); ++k) {
    if (shared[static_cast<std::size_t>(k)] > 0) order.push_back(k);
  }
  std::stable_sort(order.begin(), order.end(), [&](KeyframeId a, KeyframeId b) {
    return shared[static_cast<std::size_t>(a)] > shared[static_cast<std::size_t>(b)];
  });
  if (static_cast<int>(order.size()) > neighbours) order.resize(static_cast<std::size_t>(neighbours));
  order.push_back(keyframe);
  std::vector<PointId> points;
  for (const KeyframeId k : order) {
    for (const PointObservation& observation : map.keyframes[k].observations) {
      if (map.points.count(observation.point) > 0) points.push_back(observation.point);
    }
  }
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

SearchPoints searchPoints(const Map& map, const std::vector<PointId>& points, const Pose& world_T_camera,
                          std::vector<KeyframeId>& sources) {
  SearchPoints result;
  sources.clear();
  for (const PointId id : points) {
    const MapPoint& point = map.points.at(id);
    const Eigen::Vector3d position = worldPosition(map, point);
    const Eigen::Vector3d ray = position - world_T_camera.translation;
    const Keyframe* nearest = nullptr;
    double least_difference = std::numeric_limits<double>::max();
    const auto consider = [&](KeyframeId k) {
      const Keyframe& keyframe = map.keyframes[k];
      if (!keyframe.images) return;
      const Eigen::Vector3d its_ray = position - keyframe.world_T_camera.translation;
      const double difference = (ray - its_ray).norm();
      if (difference >= least_difference) return;
      least_difference = difference;
      nearest = &keyframe;
    };
    consider(point.host);
    for (const KeyframeId k : point.seen_in) consider(k);
    const PointObservation* seen = nearest ? findObservation(*nearest, id) : nullptr;
    if (!seen) continue;
    const Measurement& m = seen->measurement;
    sources.push_back(nearest->id);
    result.push_back({id, position, nullptr, nearest->world_T_camera, m.pixel.cast<float>(), m.normal.cast<float>(),
                      seen->corner, static_cast<float>(m.sigma_normal), static_cast<float>(m.sigma_tangent),
                      nearest->twist});
  }
  return result;
}

ScreenedPose screenPose(const Camera& camera, const Map& map, const std::vector<PointId>& points,
                        const SearchedFrame& frame, const Pose& world_T_camera, const GuidedSearchOptions& options) {
  const Round round{options.screening_radius, 2, 6, options.screened_points};
  const RoundResult result = searchOnce(camera, map, points, frame, world_T_camera, options, round);
  return {result.pose.world_T_camera, countEvidence(result)};
}

std::string reasonToRefuse(const PoseEvidence& evidence, const GuidedSearchOptions& options) {
  const bool bare = evidence.corner_inliers < options.telling_corners;
  const bool many = evidence.corner_inliers >= options.many_corners;
  const double inlier_share = many   ? options.many_corners_inlier_share
                              : bare ? options.bare_inlier_share
                                     : options.inlier_share;
  const double corner_share = many   ? options.many_corners_share
                              : bare ? options.bare_corner_share
                                     : options.corner_share;
  if (evidence.inliers < std::max<double>(options.fewest_inliers, inlier_share * evidence.visible)) {
    return of(evidence.inliers, evidence.visible, "points in view agree");
  }
  if (evidence.visible_corners >= options.fewest_corners &&
      evidence.corner_inliers < corner_share * evidence.visible_corners) {
    return of(evidence.corner_inliers, evidence.visible_corners, "corners in view agree");
  }
  if (bare && !many && evidence.explained < options.explained_share) {
    return "only " + std::to_string(static_cast<int>(100 * evidence.explained)) +
           " % of the frame's edges are the map's";
  }
  if (evidence.cells < options.fewest_cells) return "what agrees covers too little of the image";
  if (!(evidence.position_sigma < options.position_sigma)) return "what agrees leaves the position undetermined";
  if (!(evidence.rotation_sigma_deg < options.rotation_sigma_deg)) {
    return "what agrees leaves the rotation undetermined";
  }
  return "";
}

GuidedSearchResult guidedSearch(const Camera& camera, const Map& map, const std::vector<PointId>& points,
                                const SearchedFrame& frame, const Pose& world_T_camera,
                                const GuidedSearchOptions& options) {
  const Round rounds[] = {{2 * options.search.radius, 1, 3, options.screened_points},
                          {options.search.radius, options.search.coarsest_level, 1, options.searched_points}};
  GuidedSearchResult result;
  RoundResult last;
  last.pose.world_T_camera = world_T_camera;
  for (const Round& round : rounds) {
    last = searchOnce(camera, map, points, frame, last.pose.world_T_camera, options, round);
    result.pose = last.pose;
    result.evidence = countEvidence(last);
    if (!last.pose.converged) {
      result.reason = "what was found of the map gives no pose";
      return result;
    }
  }
  std::vector<double> distances;
  for (std::size_t i = 0; i < last.matches.size(); ++i) {
    if (!last.pose.inliers[i]) continue;
    result.inliers.push_back(last.matches[i]);
    distances.push_back(last.distances[i]);
  }
  PoseEvidence& evidence = result.evidence;
  evidence.cells = cellsCovered(camera, result.inliers);
  evidence.median_distance = upperMedian(distances);
  evidence.position_sigma = largestSigma(last.pose.covariance.topLeftCorner<3, 3>()) / evidence.median_distance;
  std::vector<KeyframeId> sources;
  const Pose& pose = last.pose.world_T_camera;
  const SearchPoints around = searchPoints(map, points, pose, sources);
  evidence.explained =
      explainedShare(frame.edges, visiblePoints(camera, around, pose, options.search), options.explained_edges);
  evidence.rotation_sigma_deg = degrees(largestSigma(last.pose.covariance.bottomRightCorner<3, 3>()));
  result.reason = reasonToRefuse(evidence, options);
  result.accepted = result.reason.empty();
  return result;
}

}  // namespace edgeslam
