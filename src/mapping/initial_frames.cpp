#include "mapping/initial_frames.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "mapping/points_seen_by_both.h"

namespace edgeslam {
namespace {

constexpr std::size_t most_frames = 400;

void keepPointsOf(const TrackedFrame& first, TrackedFrame& frame) {
  std::vector<PointObservation> kept;
  kept.reserve(frame.observations.size());
  forEachCommon(first, frame, [&](std::size_t, std::size_t j) { kept.push_back(frame.observations[j]); });
  frame.observations = std::move(kept);
}

}  // namespace

void addFrame(InitialFrames& frames, const TrackedFrame& frame) {
  frames.since.push_back(frame);
  keepPointsOf(frames.first, frames.since.back());
  if (frames.since.size() <= most_frames) return;
  std::vector<TrackedFrame> thinned;
  for (std::size_t i = 1; i < frames.since.size(); i += 2) thinned.push_back(std::move(frames.since[i]));
  frames.since = std::move(thinned);
}

std::vector<std::size_t> spreadFrames(const InitialFrames& frames, int count) {
  assert(count >= 1);
  std::vector<std::size_t> spread;
  const auto parts = static_cast<std::size_t>(count);
  for (std::size_t k = 1; k <= parts; ++k) {
    const std::size_t end = frames.since.size() * k / parts;
    if (end >= 1 && (spread.empty() || spread.back() != end - 1)) spread.push_back(end - 1);
  }
  return spread;
}

int cornersSeen(const InitialFrames& frames) {
  const std::vector<PointObservation>& seen = frames.current().observations;
  return static_cast<int>(std::count_if(seen.begin(), seen.end(), [](const PointObservation& o) { return o.corner; }));
}

CommonBearings commonBearings(const TrackedFrame& first, const TrackedFrame& other) {
  CommonBearings bearings;
  forEachCommon(first, other, [&](std::size_t i, std::size_t j) {
    bearings.in_first.push_back(first.observations[i].bearing);
    bearings.in_other.push_back(other.observations[j].bearing);
  });
  return bearings;
}

}  // namespace edgeslam
