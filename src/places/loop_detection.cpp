#include "places/loop_detection.h"

#include <algorithm>
#include <cmath>

#include "geometry/angles.h"

namespace edgeslam {
namespace {

// P24: the lowest score among the keyframes before the current one that look about the same way.
double barOf(const Map& map, KeyframeId current, const std::vector<double>& scores,
             const LoopDetectionOptions& options) {
  double bar = 1;
  int counted = 0;
  for (KeyframeId k = current - 1; k >= 0 && counted < options.bar_keyframes; --k) {
    if (scores[static_cast<std::size_t>(k)] == no_score) continue;
    if (keyframeOf(map, k).world != keyframeOf(map, current).world) continue;
    const double angle =
        rotationAngle(keyframeOf(map, current).world_T_camera.rotation, keyframeOf(map, k).world_T_camera.rotation);
    if (degrees(angle) >= options.bar_rotation_deg) continue;
    bar = std::min(bar, scores[static_cast<std::size_t>(k)]);
    ++counted;
  }
  return bar;
}

}  // namespace

std::vector<char> mayCloseLoop(const Map& map, KeyframeId current, const LoopDetectionOptions& options) {
  const std::vector<int> shared = sharedPoints(map, current);
  const int most = shared.empty() ? 0 : *std::max_element(shared.begin(), shared.end());
  std::vector<char> may(shared.size(), 0);
  int without = 0;  // keyframes in a row that share nothing
  bool left = false;
  for (std::size_t place = map.keyframes.placeOf(current); place-- > 0;) {
    const auto id = static_cast<std::size_t>(map.keyframes.atPlace(place).id);
    without = shared[id] == 0 ? without + 1 : 0;
    left = left || without > options.recent_keyframes;
    may[id] = shared[id] == 0 || (left && shared[id] < options.held_share * most);
  }
  return may;
}

LoopDetection detectLoops(const Map& map, KeyframeId current, const std::vector<double>& scores,
                          const LoopDetectionOptions& options) {
  LoopDetection detection;
  detection.bar = barOf(map, current, scores, options);
  const std::vector<char> may = mayCloseLoop(map, current, options);

  std::vector<LoopCandidate> run;  // consecutive keyframes over the bar
  const auto endRun = [&] {
    for (std::size_t i = 0; i < run.size() && static_cast<int>(run.size()) >= options.consecutive; ++i) {
      const bool best =
          (i == 0 || run[i].score > run[i - 1].score) && (i + 1 == run.size() || run[i].score >= run[i + 1].score);
      if (best) detection.candidates.push_back(run[i]);
    }
    run.clear();
  };
  int world = 0;  // of the run
  for (KeyframeId k = 0; k < current; ++k) {
    const double score = scores[static_cast<std::size_t>(k)];
    if (score == no_score) continue;
    const Keyframe& keyframe = keyframeOf(map, k);
    const bool is_recent = k >= current - options.recent_keyframes;
    if (is_recent && keyframe.world == keyframeOf(map, current).world) continue;
    if (keyframe.world != world) endRun();
    world = keyframe.world;
    if (score > detection.bar && may[static_cast<std::size_t>(k)]) {
      run.push_back({k, score});
    } else {
      endRun();
    }
  }
  endRun();
  std::stable_sort(detection.candidates.begin(), detection.candidates.end(),
                   [](const LoopCandidate& a, const LoopCandidate& b) { return a.score > b.score; });
  if (static_cast<int>(detection.candidates.size()) > options.most_candidates) {
    detection.candidates.resize(static_cast<std::size_t>(options.most_candidates));
  }
  return detection;
}

}  // namespace edgeslam
