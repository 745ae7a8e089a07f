#include "places/relocalisation.h"

#include <algorithm>

#include "geometry/angles.h"
#include "geometry/resectioning.h"

namespace edgeslam {
namespace {

// Two sizes of the patch on either side bridge distances that differ by up to twice; more would only cost.
DescribedPoints describeAtTwoSizes(const cv::Mat& grey, const std::vector<Eigen::Vector2f>& pixels, double roll) {
  DescribedPoints described = describePoints(grey, pixels, roll);
  if (described.descriptors.size() > 2) described.descriptors.resize(2);
  return described;
}

// Of other worlds nothing is known.
bool isReachable(const std::optional<Reachable>& reachable, int world, const Pose& pose, double widening) {
  return !reachable || world != reachable->world ||
         (pose.translation - reachable->centre).norm() <= widening * reachable->distance;
}

}  // namespace

void Relocalisation::addKeyframe(const Keyframe& keyframe) {
  if (!keyframe.images) return;
  const std::shared_ptr<const FrameImages> images = keyframe.images.get();
  const ImagePyramid& pyramid = images->pyramid;
  std::vector<const PointObservation*> chosen;
  for (const PointObservation& observation : keyframe.observations) chosen.push_back(&observation);
  std::stable_partition(chosen.begin(), chosen.end(), [](const PointObservation* o) { return o->corner; });
  if (static_cast<int>(chosen.size()) > options_.described_points) {
    chosen.resize(static_cast<std::size_t>(options_.described_points));
  }
  std::vector<Eigen::Vector2f> pixels;
  pixels.reserve(chosen.size());
  for (const PointObservation* observation : chosen) {
    pixels.emplace_back(observation->measurement.pixel.cast<float>());
  }
  KnownKeyframe known;
  known.frame_index = keyframe.frame_index;
  known.thumbnail = makeThumbnail(pyramid, camera_.mask.get());
  known.described = describeAtTwoSizes(pyramid.levels[0], pixels, 0);
  for (const int index : known.described.points) known.points.push_back(chosen[static_cast<std::size_t>(index)]->point);
  keyframes_[keyframe.id] = std::move(known);
}

void Relocalisation::update(const Map& map) {
  for (auto known = keyframes_.begin(); known != keyframes_.end();) {
    const Keyframe* keyframe = map.keyframes.find(known->first);
    const bool fits = keyframe && keyframe->frame_index == known->second.frame_index;
    known = fits ? std::next(known) : keyframes_.erase(known);
  }
  for (const Keyframe& keyframe : map.keyframes) {
    if (keyframes_.count(keyframe.id) == 0) addKeyframe(keyframe);
  }
}

std::vector<Relocalisation::Candidate> Relocalisation::candidates(const Map& map, const Thumbnail& thumbnail,
                                                                  KeyframeId latest) const {
  const auto better = [](const Candidate& a, const Candidate& b) { return a.match.correlation > b.match.correlation; };
  std::vector<Candidate> ranked;
  for (const auto& [id, known] : keyframes_) {
    if (id > latest || !map.keyframes.contains(id) || known.thumbnail.size() != thumbnail.size()) continue;
    ranked.push_back({id, matchShifted(known.thumbnail, thumbnail)});
  }
  std::stable_sort(ranked.begin(), ranked.end(), better);
  ranked = differentPlaces(map, ranked, 2 * options_.candidates_of_place, options_.compared_turned);
  for (Candidate& candidate : ranked)
    candidate.match = matchTurned(keyframes_.at(candidate.keyframe).thumbnail, thumbnail);
  std::stable_sort(ranked.begin(), ranked.end(), better);
  while (!ranked.empty() && ranked.back().match.correlation < options_.least_correlation) ranked.pop_back();
  return differentPlaces(map, ranked, options_.candidates_of_place, options_.candidates);
}

// The first `wanted` candidates but, as long as there are others, no more than `of_place` of one place: what repeats
// must be seen to repeat.
std::vector<Relocalisation::Candidate> Relocalisation::differentPlaces(const Map& map,
                                                                       const std::vector<Candidate>& ranked,
                                                                       int of_place, int wanted) const {
  std::vector<Candidate> chosen, others;
  for (const Candidate& candidate : ranked) {
    if (static_cast<int>(chosen.size()) == wanted) return chosen;
    const std::vector<int> shared = sharedPoints(map, candidate.keyframe);
    const auto& observations = map.keyframes[candidate.keyframe].observations;
    const auto mapped = static_cast<double>(std::count_if(
        observations.begin(), observations.end(), [&](const auto& o) { return map.points.count(o.point) > 0; }));
    int of_this_place = 0;
    for (const Candidate& other : chosen) {
      of_this_place += shared[static_cast<std::size_t>(other.keyframe)] > options_.same_place_share * mapped ? 1 : 0;
    }
    (of_this_place < of_place ? chosen : others).push_back(candidate);
  }
  for (const Candidate& candidate : others) {
    if (static_cast<int>(chosen.size()) < wanted) chosen.push_back(candidate);
  }
  return chosen;
}

std::optional<Pose> Relocalisation::poseByDescriptors(const Map& map, KeyframeId keyframe,
                                                      const DescribedPoints& frame) const {
  const KnownKeyframe& known = keyframes_.at(keyframe);
  Vectors3 points, bearings;
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

// As if the camera had stood where the keyframe's did and only turned.
std::vector<Relocalisation::Start> Relocalisation::startsByTurning(const Map& map,
                                                                   const std::vector<Candidate>& candidates) const {
  std::vector<Start> starts;
  for (const Candidate& candidate : candidates) {
    const Pose& pose = map.keyframes[candidate.keyframe].world_T_camera;
    starts.push_back({candidate.keyframe, pose * Pose{rotationOf(camera_, candidate.match), Eigen::Vector3d::Zero()}});
  }
  return starts;
}

std::vector<Relocalisation::Start> Relocalisation::startsByDescriptors(const Map& map,
                                                                       const std::vector<Candidate>& candidates,
                                                                       const SearchedFrame& searched) const {
  const cv::Mat& grey = searched.images.pyramid.levels[0];
  std::vector<Eigen::Vector2f> pixels;
  for (const ChosenPoint& point : choosePoints(grey, searched.edges, {}, options_.points, searched.accuracy))
    pixels.push_back(point.pixel);
  std::vector<Start> starts;
  DescribedPoints frame;
  double described_roll = 0;
  for (const Candidate& candidate : candidates) {
    if (static_cast<int>(starts.size()) == options_.matched_candidates) break;
    const double roll = -candidate.match.roll;
    if (frame.points.empty() || roll != described_roll) frame = describeAtTwoSizes(grey, pixels, roll);
    described_roll = roll;
    if (const auto pose = poseByDescriptors(map, candidate.keyframe, frame))
      starts.push_back({candidate.keyframe, *pose});
  }
  return starts;
}

// A first look from each start, then the best are followed up. The best of what is accepted is the result, unless
// another pose rivals it.
void Relocalisation::searchFrom(const std::vector<Start>& starts, const Map& map, const SearchedFrame& frame,
                                const std::optional<Reachable>& reachable, RelocalisationResult& result) const {
  struct Screened {
    KeyframeId keyframe;
    std::vector<PointId> points;
    ScreenedPose pose;
  };
  const GuidedSearchOptions& options = options_.guided_search;
  std::vector<Screened> screened;
  for (const Start& start : starts) {
    const int world = map.keyframes[start.keyframe].world;
    if (!isReachable(reachable, world, start.world_T_camera, 2)) continue;  // it is a guess yet
    Screened look{start.keyframe, pointsAround(map, start.keyframe, options.neighbours), {}};
    look.pose = screenPose(camera_, map, look.points, frame, start.world_T_camera, options);
    if (look.pose.evidence.share() >= options_.screened_share) screened.push_back(std::move(look));
  }
  std::stable_sort(screened.begin(), screened.end(), [](const Screened& a, const Screened& b) {
    return a.pose.evidence.share() > b.pose.evidence.share();
  });
  const auto ofOtherWorld = [&](KeyframeId keyframe) {
    return map.keyframes[keyframe].world != map.keyframes[result.keyframe].world;
  };
  const auto different = [&](const Pose& pose) {
    const double distance = (pose.translation - result.world_T_camera.translation).norm();
    return distance > options_.rival_distance * result.evidence.median_distance ||
           rotationAngle(pose.rotation, result.world_T_camera.rotation) > radians(options_.rival_rotation_deg);
  };
  int followed_up = 0;
  for (const Screened& look : screened) {
    if (result.found && !ofOtherWorld(look.keyframe) && !different(look.pose.world_T_camera)) continue;
    if (followed_up++ == options_.refined_poses) break;
    GuidedSearchResult search = guidedSearch(camera_, map, look.points, frame, look.pose.world_T_camera, options);
    if (search.accepted && !isReachable(reachable, map.keyframes[look.keyframe].world, search.pose.world_T_camera, 1)) {
      search.accepted = false;
      search.reason = "what looks like it is out of reach";
    }
    const double share = search.evidence.explained, best = result.evidence.explained;
    // Two worlds may both have seen this place, and be one; within a world it can only be at one.
    if (result.found && search.accepted && !ofOtherWorld(look.keyframe) && different(search.pose.world_T_camera) &&
        std::min(share, best) > options_.rival_share * std::max(share, best)) {
      result.found = false;
      result.matches.clear();
      result.reason = "two different poses are as good";
      return;
    }
    if (search.accepted == result.found ? share <= best : result.found) continue;
    result.found = search.accepted;
    result.reason = std::move(search.reason);
    result.world_T_camera = search.pose.world_T_camera;
    result.pose = std::move(search.pose);
    result.keyframe = look.keyframe;
    result.evidence = search.evidence;
    result.matches.clear();
    if (result.found) result.matches = std::move(search.inliers);
  }
}

RelocalisationResult Relocalisation::relocalise(const Map& map, const FrameImages& current, const EdgeMap& edges,
                                                const std::optional<Reachable>& reachable, double noise_factor,
                                                KeyframeId latest) const {
  RelocalisationResult result;
  const std::vector<Candidate> tried = candidates(map, makeThumbnail(current.pyramid, camera_.mask.get()), latest);
  if (tried.empty()) {
    result.reason = "no keyframe looks like this frame";
    return result;
  }
  result.reason = "from no keyframe does the map show in this frame";
  SearchedFrame frame{current, edges, accuracyIn(current.pyramid.levels[0], accuracy_, camera_.mask.get())};
  frame.accuracy.noise_factor = noise_factor;
  searchFrom(startsByTurning(map, tried), map, frame, reachable, result);
  if (result.evidence.visible > 0) return result;  // another start would lead to the same pose
  searchFrom(startsByDescriptors(map, tried, frame), map, frame, reachable, result);
  return result;
}

}  // namespace edgeslam
