#include "places/loop_closing.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "geometry/angles.h"
#include "places/reach.h"
#include "tracking/measured_noise.h"

namespace edgeslam {
namespace {

bool areOfOneWorld(const Map& map, KeyframeId a, KeyframeId b) {
  return keyframeOf(map, a).world == keyframeOf(map, b).world;
}

// Length of the way from one keyframe to a later one of the same world.
double wayBetween(const Map& map, KeyframeId from, KeyframeId to) {
  double way = 0;
  const Keyframe* last = &keyframeOf(map, from);
  for (std::size_t place = map.keyframes.placeOf(from) + 1; place <= map.keyframes.placeOf(to); ++place) {
    const Keyframe& next = map.keyframes.atPlace(place);
    if (next.world != last->world) continue;
    way += (next.world_T_camera.translation - last->world_T_camera.translation).norm();
    last = &next;
  }
  return way;
}

// Where a loop says that the current keyframe is.
Pose impliedPose(const Map& map, const JudgedLoop& loop) {
  const Similarity candidate_S_current = loop.verification.current_S_candidate.inverse();
  return keyframeOf(map, loop.keyframe).world_T_camera *
         Pose{candidate_S_current.rotation, candidate_S_current.translation};
}

bool fewerInliers(const JudgedLoop& a, const JudgedLoop& b) {
  if (a.accepted != b.accepted) return b.accepted;
  return a.verification.inliers < b.verification.inliers;
}

}  // namespace

void refuseContradictions(const Map& map, KeyframeId current, std::vector<JudgedLoop>& loops) {
  constexpr double largest_turn = radians(15);  // between what two loops say [rad] ...
  constexpr double largest_distance = 0.5;      // ... and of the distance of the scene
  const double distance = largest_distance * sceneDistance(map, keyframeOf(map, current));
  std::vector<std::size_t> contradicted;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    for (std::size_t j = 0; j < loops.size(); ++j) {
      if (i == j || !loops[i].accepted || !loops[j].accepted) continue;
      if (!areOfOneWorld(map, loops[i].keyframe, loops[j].keyframe)) continue;
      const Pose one = impliedPose(map, loops[i]), other = impliedPose(map, loops[j]);
      if (rotationAngle(one.rotation, other.rotation) < largest_turn &&
          (one.translation - other.translation).norm() < distance) {
        continue;
      }
      contradicted.push_back(i);
      loops[i].reason = "looks like keyframe " + std::to_string(loops[j].keyframe) + " too, elsewhere";
    }
  }
  for (const std::size_t i : contradicted) loops[i].accepted = false;
}

LoopOutcome LoopClosing::addKeyframe(const Map& map) {
  LoopOutcome outcome;
  if (!options_.enabled || map.keyframes.empty()) return outcome;
  describeNew(map);
  outcome.current = map.keyframes.back().id;
  const auto& current = known_.at(outcome.current).signature;
  if (!current) return outcome;
  if (last_loop_ >= 0 && outcome.current - last_loop_ <= options_.pause_keyframes) return outcome;

  std::vector<double> scores(static_cast<std::size_t>(outcome.current), no_score);
  for (const auto& [id, known] : known_) {
    if (id == outcome.current || !known.signature) continue;
    if (!areOfOneWorld(map, outcome.current, id) || withinDrift(map, outcome.current, id))
      scores[static_cast<std::size_t>(id)] = score(*known.signature, *current);
  }
  const LoopDetection detection = detectLoops(map, outcome.current, scores, options_.detection);
  outcome.bar = detection.bar;
  for (const LoopCandidate& candidate : detection.candidates) {
    outcome.considered.push_back(judge(map, outcome.current, candidate));
    acceptAgreeingJoin(map, outcome.current, outcome.considered.back());
    refuseWhereKnownOtherwise(map, outcome.current, outcome.considered.back());
    for (const Keyframe& keyframe : map.keyframes) keyframe.images.pack();  // the next one is of other keyframes
  }
  refuseContradictions(map, outcome.current, outcome.considered);
  const auto best = std::max_element(outcome.considered.begin(), outcome.considered.end(), fewerInliers);
  if (best == outcome.considered.end() || !best->accepted) return outcome;
  LoopCorrection correction;
  if (computeCorrection(camera_, map, outcome.current, best->keyframe, best->verification, options_.verification,
                        options_.correction, correction)) {
    outcome.correction = std::move(correction);
    last_loop_ = outcome.current;
  } else {
    best->accepted = false;
    best->reason = "the pose graph has no solution";
  }
  return outcome;
}

void LoopClosing::describeNew(const Map& map) {
  for (auto known = known_.begin(); known != known_.end();) {
    const Keyframe* keyframe = map.keyframes.find(known->first);
    const bool fits = keyframe && keyframe->frame_index == known->second.frame_index;
    known = fits ? std::next(known) : known_.erase(known);
  }
  if (last_loop_ > map.keyframes.back().id) last_loop_ = -1;
  const std::vector<int> worlds = worldsOf(map);
  const auto isGone = [&](const auto& proposed) {
    const WorldJoin& join = proposed.second;
    return !std::binary_search(worlds.begin(), worlds.end(), join.from) ||
           !std::binary_search(worlds.begin(), worlds.end(), join.to);
  };
  proposed_joins_.erase(std::remove_if(proposed_joins_.begin(), proposed_joins_.end(), isGone), proposed_joins_.end());
  for (const Keyframe& keyframe : map.keyframes) {
    if (known_.count(keyframe.id) > 0) continue;
    Known known;
    known.frame_index = keyframe.frame_index;
    if (keyframe.images) {
      const std::shared_ptr<const FrameImages> images = keyframe.images.get();
      const cv::Mat& grey = images->pyramid.levels[0];
      const CameraMask* mask = camera_.mask.get();
      known.signature = edgeSignature(grey, detectEdges(grey, reading_.edges, mask), mask);
    }
    known_.emplace(keyframe.id, std::move(known));
  }
}

double LoopClosing::score(const EdgeSignature& a, const EdgeSignature& b) const {
  const double paper = signatureScore(a, b, options_.signature);
  if (options_.thumbnail_weight <= 0) return paper;
  const double thumbnail = std::max(0.0, thumbnailScore(a, b, options_.thumbnail_shift));
  return (1 - options_.thumbnail_weight) * paper + options_.thumbnail_weight * thumbnail;
}

// Far from what drift can explain a place only looks alike, and would take a candidate's place from the true one.
bool LoopClosing::withinDrift(const Map& map, KeyframeId current, KeyframeId earlier) const {
  const Pose& world_T_earlier = keyframeOf(map, earlier).world_T_camera;
  const Pose& world_T_current = keyframeOf(map, current).world_T_camera;
  const double turn = degrees(rotationAngle(world_T_earlier.rotation, world_T_current.rotation));
  if (turn > options_.largest_turn_deg + options_.largest_view_turn_deg) return false;
  const double apart = (world_T_earlier.translation - world_T_current.translation).norm();
  return apart < allowedMove(map, current, earlier) + std::max(sceneDistance(map, keyframeOf(map, earlier)),
                                                               sceneDistance(map, keyframeOf(map, current)));
}

double LoopClosing::allowedMove(const Map& map, KeyframeId current, KeyframeId earlier) const {
  return options_.largest_drift * (wayBetween(map, earlier, current) + sceneDistance(map, keyframeOf(map, earlier)));
}

JudgedLoop LoopClosing::judge(const Map& map, KeyframeId current, const LoopCandidate& candidate) const {
  JudgedLoop judged;
  judged.keyframe = candidate.keyframe;
  judged.score = candidate.score;
  const std::uint64_t seed =
      options_.seed + static_cast<std::uint64_t>(current) * 1000003u + static_cast<std::uint64_t>(candidate.keyframe);
  LoopVerificationOptions verification = options_.verification;
  if (!areOfOneWorld(map, current, candidate.keyframe)) verification.largest_scale = options_.largest_world_scale;
  judged.verification = verifyLoop(camera_, reading_, map, current, candidate.keyframe, verification, seed);
  judged.reason = judged.verification.reason;
  if (!judged.verification.accepted) return judged;
  judged.accepted = true;
  if (!areOfOneWorld(map, current, candidate.keyframe))
    return judged;  // nothing is known of where they are to each other

  // Drift grows with the way: what would move the keyframe farther than drift can is another place that looks the same.
  const Pose& world_T_candidate = keyframeOf(map, candidate.keyframe).world_T_camera;
  const Pose& world_T_current = keyframeOf(map, current).world_T_camera;
  const Similarity candidate_S_current = judged.verification.current_S_candidate.inverse();
  const double turn =
      degrees(rotationAngle(world_T_candidate.rotation * candidate_S_current.rotation, world_T_current.rotation));
  const double move = (world_T_candidate * candidate_S_current.translation - world_T_current.translation).norm();
  const double allowed = allowedMove(map, current, candidate.keyframe);
  char text[160];
  judged.accepted = turn <= options_.largest_turn_deg && move <= allowed;
  if (turn > options_.largest_turn_deg) {
    std::snprintf(text, sizeof(text), "would turn the keyframe by %.0f deg", turn);
    judged.reason = text;
  } else if (move > allowed) {
    std::snprintf(text, sizeof(text), "would move the keyframe by %.2f, over %.2f that drift can", move, allowed);
    judged.reason = text;
  }
  return judged;
}

// What an inertial unit or wheels know, no look-alike may contradict, nor how far the camera can have come.
void LoopClosing::refuseWhereKnownOtherwise(const Map& map, KeyframeId current, JudgedLoop& judged) const {
  if (!judged.accepted) return;
  const WorldJoin join = joinOf(map, current, judged.keyframe, judged.verification.current_S_candidate);
  std::string why =
      contradiction(knownFrame(map, join.from), knownFrame(map, join.to), join.to_S_from, options_.known_frame);
  if (why.empty() && judged.verification.corner_inliers < options_.telling_corners) why = outOfReach(map, join);
  if (why.empty()) return;
  judged.accepted = false;
  judged.reason = why;
}

// A loop between worlds that only descriptors accept, or nothing quite, where other keyframes said the same before.
void LoopClosing::acceptAgreeingJoin(const Map& map, KeyframeId current, JudgedLoop& judged) {
  const LoopVerification& verification = judged.verification;
  if (judged.accepted || areOfOneWorld(map, current, judged.keyframe)) return;
  if (!verification.accepted_by_descriptors && !verification.nearly_found) return;
  if (noiseFactorOf(keyframeOf(map, current), reading_.accuracy) < options_.rough_noise_factor) return;
  const WorldJoin join = joinOf(map, current, judged.keyframe, verification.current_S_candidate);
  const bool is_younger = keyframeOf(map, current).world == join.from;
  const KeyframeId younger = is_younger ? current : judged.keyframe, older = is_younger ? judged.keyframe : current;
  const Pose& from_T_camera = keyframeOf(map, younger).world_T_camera;
  const Pose here = moved(join.to_S_from, from_T_camera);
  const double distance = options_.agreeing_distance * sceneDistance(map, keyframeOf(map, older));
  std::set<KeyframeId> agreeing;
  for (const auto& [keyframe, proposed] : proposed_joins_) {
    if (keyframe == current || proposed.from != join.from || proposed.to != join.to) continue;
    const Pose there = moved(proposed.to_S_from, from_T_camera);
    const bool agrees = degrees(rotationAngle(here.rotation, there.rotation)) <= options_.agreeing_turn_deg &&
                        (here.translation - there.translation).norm() <= distance &&
                        std::abs(std::log(join.to_S_from.scale / proposed.to_S_from.scale)) <= options_.agreeing_scale;
    if (agrees) agreeing.insert(keyframe);
  }
  proposed_joins_.emplace_back(current, join);
  const int enough =
      verification.accepted_by_descriptors ? options_.agreeing_keyframes : options_.agreeing_near_keyframes;
  judged.accepted = static_cast<int>(agreeing.size()) >= enough;
  judged.reason +=
      "; " + std::to_string(agreeing.size()) + " of " + std::to_string(enough) + " other keyframes say the same";
}

}  // namespace edgeslam
