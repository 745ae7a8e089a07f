#include "places/relocalisation.h"

#include <algorithm>

#include "geometry/resectioning.h"

namespace edgeslam {

void Relocalisation::addKeyframe(const Keyframe& keyframe) {
  if (!keyframe.images) return;
  const ImagePyramid& pyramid = keyframe.images->pyramid;
  std::vector<Eigen::Vector2f> pixels;
  for (const PointObservation& observation : keyframe.observations) {
    pixels.push_back(observation.measurement.pixel.cast<float>());
  }
  KnownKeyframe known;
  known.thumbnail = makeThumbnail(pyramid);
  known.described = describePoints(pyramid.levels[0], pixels, 0);
  for (const int index : known.described.points) {
    known.points.push_back(keyframe.observations[static_cast<std::size_t>(index)].point);
  }
  keyframes_[keyframe.id] = std::move(known);
}

std::vector<Relocalisation::Candidate> Relocalisation::candidates(const Map& map, const Thumbnail& thumbnail) const {
  const auto better = [](const Candidate& a, const Candidate& b) { return a.match.correlation > b.match.correlation; };
  std::vector<Candidate> ranked;
  for (const auto& [id, known] : keyframes_) {
    if (static_cast<std::size_t>(id) >= map.keyframes.size() || known.thumbnail.size() != thumbnail.size()) continue;
    ranked.push_back({id, matchShifted(known.thumbnail, thumbnail)});
  }
  std::stable_sort(ranked.begin(), ranked.end(), better);
  if (static_cast<int>(ranked.size()) > options_.compared_turned)
    ranked.resize(static_cast<std::size_t>(options_.compared_turned));
  for (Candidate& candidate : ranked)
    candidate.match = matchTurned(keyframes_.at(candidate.keyframe).thumbnail, thumbnail);
  std::stable_sort(ranked.begin(), ranked.end(), better);
  while (!ranked.empty() && (static_cast<int>(ranked.size()) > options_.candidates ||
                             ranked.back().match.correlation < options_.least_correlation)) {
    ranked.pop_back();
  }
  return ranked;
}

std::optional<Pose> Relocalisation::poseByDescriptors(const Map& map, KeyframeId keyframe,
                                                      const DescribedPoints& frame) const {
  const KnownKeyframe& known = keyframes_.at(keyframe);
  std::vector<Eigen::Vector3d> points, bearings;
  for (const auto& [mine, its] : matchDescriptors(frame, known.described, options_.matching)) {
    const auto point = map.points.find(known.points[static_cast<std::size_t>(its)]);
    if (point == map.points.end()) continue;
    points.push_back(worldPosition(map, point->second));
    bearings.push_back(bearing(camera_, frame.pixels[static_cast<std::size_t>(mine)].cast<double>()));
  }
  if (static_cast<int>(points.size()) < options_.fewest_matches) return std::nullopt;
  const ResectioningResult result = resection(points, bearings, options_.descriptor_error / meanFocalLength(camera_),
                                              /*seed=*/1, options_.ransac_iterations);
  if (!result.found || result.inlier_count < options_.fewest_matches) return std::nullopt;
  return result.camera_T_world.inverse();
}

RelocalisationResult Relocalisation::relocalise(const Map& map, const FrameImages& current,
                                                const EdgeMap& edges) const {
  RelocalisationResult result;
  const std::vector<Candidate> tried = candidates(map, makeThumbnail(current.pyramid));
  if (tried.empty()) {
    result.reason = "no keyframe looks like this frame";
    return result;
  }
  int most_inliers = -1;
  const auto searchFrom = [&](KeyframeId keyframe, const Pose& start) {
    const std::vector<PointId> points = pointsAround(map, keyframe, options_.guided_search.neighbours);
    GuidedSearchResult search = guidedSearch(camera_, map, points, current, edges, start, options_.guided_search);
    if (!search.accepted && search.pose.inlier_count <= most_inliers) return false;
    most_inliers = search.pose.inlier_count;
    result.found = search.accepted;
    result.reason = std::move(search.reason);
    result.world_T_camera = search.pose.world_T_camera;
    result.pose = std::move(search.pose);
    result.keyframe = keyframe;
    result.visible = search.visible;
    if (result.found) result.matches = std::move(search.inliers);
    return result.found;
  };

  // First as if the camera had only turned, which is cheap.
  for (const Candidate& candidate : tried) {
    const Pose& pose = map.keyframes[static_cast<std::size_t>(candidate.keyframe)].world_T_camera;
    const Pose start = pose * Pose{rotationOf(camera_, candidate.match), Eigen::Vector3d::Zero()};
    if (searchFrom(candidate.keyframe, start)) return result;
  }

  const cv::Mat& grey = current.pyramid.levels[0];
  std::vector<Eigen::Vector2f> pixels;
  for (const ChosenPoint& point : choosePoints(grey, edges, {}, options_.points)) pixels.push_back(point.pixel);
  DescribedPoints frame;
  double described_roll = 0;
  for (int i = 0; i < std::min(options_.matched_candidates, static_cast<int>(tried.size())); ++i) {
    const Candidate& candidate = tried[static_cast<std::size_t>(i)];
    const double roll = -candidate.match.roll;
    if (frame.points.empty() || roll != described_roll) frame = describePoints(grey, pixels, roll);
    described_roll = roll;
    const std::optional<Pose> start = poseByDescriptors(map, candidate.keyframe, frame);
    if (start && searchFrom(candidate.keyframe, *start)) return result;
  }
  return result;
}

}  // namespace edgeslam
