#include "flow/optical_flow.h"

#include <cmath>
#include <limits>

namespace edgeslam {
namespace {

AlignmentOptions alignmentOptions(const FlowOptions& options) {
  AlignmentOptions alignment;
  alignment.iterations = options.iterations;
  alignment.damping = static_cast<float>(options.damping);
  return alignment;
}

}  // namespace

FlowMatch followPoint(const ImagePyramid& from, const ImagePyramid& to, const Eigen::Vector2f& pixel,
                      const Eigen::Vector2f& prediction, const FlowOptions& options) {
  const AlignmentOptions alignment = alignmentOptions(options);
  const int coarsest =
      std::min({options.levels, static_cast<int>(from.levels.size()), static_cast<int>(to.levels.size())}) - 1;
  FlowMatch match;
  Eigen::Vector2f estimate = prediction;
  PatchTemplate patch;
  const int finest = std::min(options.finest_level, coarsest);
  for (int level = coarsest; level >= finest; --level) {
    const float scale = 1.0f / static_cast<float>(1 << level);
    const auto index = static_cast<std::size_t>(level);
    const bool taken =
        makeTemplate(from.levels[index], pixel * scale, Eigen::Matrix2f::Identity(), options.window, patch);
    if (!taken) {
      if (level == finest) return match;
      continue;
    }
    const AlignmentResult aligned =
        alignPatch(patch, to.levels[index], estimate * scale, prediction * scale, alignment);
    if (level == finest) {
      match.found = aligned.inside && aligned.correlation >= static_cast<float>(options.least_correlation);
      match.pixel = aligned.pixel / scale;
      match.correlation = aligned.correlation;
      match.tensor = patch.tensor;
    } else if (aligned.inside && aligned.correlation > 0.5f) {
      estimate = aligned.pixel / scale;  // a coarse level that found nothing alike must not lead astray
    }
  }
  return match;
}

float backwardError(const ImagePyramid& from, const ImagePyramid& to, const Eigen::Vector2f& from_pixel,
                    const Eigen::Vector2f& to_pixel, const Eigen::Vector2f& across, const FlowOptions& options) {
  FlowOptions fine = options;
  fine.levels = std::min(options.levels, options.finest_level + 2);  // the way back starts next to its end
  const FlowMatch back = followPoint(to, from, to_pixel, from_pixel, fine);
  return back.found ? std::abs(across.dot(back.pixel - from_pixel)) : std::numeric_limits<float>::max();
}

}  // namespace edgeslam
