#include "mapping/initial_rivals.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "mapping/initial_starts.h"

namespace edgeslam {
namespace {

// Between the directions of two motions [rad]: of the same solution, and where one has a part of the points only.
constexpr double same_motion = 0.02, about_same_motion = 0.1;

template <typename T>
std::vector<T> everyNth(const std::vector<T>& all, std::size_t step) {
  std::vector<T> some;
  for (std::size_t i = 0; i < all.size(); i += step) some.push_back(all[i]);
  return some;
}

// Starts with a part of the first frame's points.
class Screening {
 public:
  Screening(const Camera& camera, const InitialFrames& frames, const InitialisationOptions& options)
      : camera_(camera), options_(options) {
    const std::vector<PointObservation>& points = frames.first.observations;
    step_ = std::max<std::size_t>(1, points.size() / static_cast<std::size_t>(options.screened_points));
    frames_.first = frames.first;
    frames_.first.observations = everyNth(points, step_);
    frames_.since.resize(frames.since.size());
    for (const std::size_t k : spreadFrames(frames, options.frames_between + 1)) frames_.since[k] = frames.since[k];
  }

  const InitialFrames& frames() const { return frames_; }

  // Of a start with all points.
  InitialStart partOf(InitialStart start) const {
    start.inverse_depths = everyNth(start.inverse_depths, step_);
    return start;
  }

  std::optional<InitialStructure> adjusted(InitialStart part) const {
    return adjustInitialStructure(camera_, frames_, std::move(part), options_);
  }

 private:
  const Camera& camera_;
  const InitialisationOptions& options_;
  InitialFrames frames_;  // of those since the first, which may be many, only those that a start has
  std::size_t step_;
};

bool isSameMotion(const InitialStart& a, const InitialStart& b, double tolerance) {
  const Eigen::Vector3d way_a = a.first_T_camera.back().translation, way_b = b.first_T_camera.back().translation;
  return (way_a.normalized() - way_b.normalized()).norm() < tolerance;
}

// Those worth being adjusted with all points, the best first. The structure itself is one where with a part of the
// points it ends elsewhere.
std::vector<InitialStructure> screenedRivals(const Screening& screening, const InitialStructure& structure,
                                             std::vector<InitialStart> rivals, const InitialisationOptions& options) {
  std::vector<InitialStructure> seen, screened, chosen;
  double least_error = std::numeric_limits<double>::infinity();
  if (const std::optional<InitialStructure> itself = screening.adjusted(screening.partOf(structure))) {
    least_error = itself->error;
    (isSameMotion(*itself, structure, about_same_motion) ? seen : screened).push_back(*itself);
  }
  for (InitialStart& start : rivals) {
    std::optional<InitialStructure> rival = screening.adjusted(std::move(start));
    if (!rival) continue;
    least_error = std::min(least_error, rival->error);
    screened.push_back(std::move(*rival));
  }
  std::stable_sort(screened.begin(), screened.end(), [](const auto& a, const auto& b) { return a.error < b.error; });
  for (InitialStructure& rival : screened) {
    if (static_cast<int>(chosen.size()) == options.most_rivals) break;
    if (rival.error > options.screened_error_ratio * least_error) break;
    const auto isSame = [&](const InitialStructure& other) { return isSameMotion(other, rival, same_motion); };
    if (std::any_of(seen.begin(), seen.end(), isSame)) continue;
    seen.push_back(rival);
    chosen.push_back(std::move(rival));
  }
  return chosen;
}

}  // namespace

InitialStructure bestOfRivals(const Camera& camera, const InitialFrames& frames, InitialStructure structure,
                              const InitialisationOptions& options) {
  const Screening screening(camera, frames, options);
  std::vector<InitialStart> rivals = steadyMotionStarts(camera, screening.frames(), options);
  if (std::optional<InitialStart> start = fivePointStart(camera, frames, options)) {
    rivals.push_back(screening.partOf(std::move(*start)));
  }
  InitialStructure best = std::move(structure);
  for (InitialStructure& screened : screenedRivals(screening, best, std::move(rivals), options)) {
    std::optional<InitialStart> start = withTriangulatedDepths(camera, frames, std::move(screened));
    if (!start) continue;
    std::optional<InitialStructure> rival = adjustInitialStructure(camera, frames, std::move(*start), options);
    if (rival && rival->error < best.error) best = std::move(*rival);
  }
  return best;
}

}  // namespace edgeslam
