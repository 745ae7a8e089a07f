#include "tracking/keyframe_selection.h"

#include <algorithm>

namespace edgeslam {

KeyframeDecision selectKeyframe(const KeyframeEvidence& evidence, int image_width, const KeyframeOptions& options) {
  if (evidence.too_soon) return {};
  const bool bare =
      evidence.mapped < options.fewest_mapped && evidence.on_straight_edges > options.bare_share * evidence.tracks;
  const double rotation_deg = bare ? std::min(options.rotation_deg, options.bare_rotation_deg) : options.rotation_deg;
  if (evidence.rotation_deg > rotation_deg) return {KeyframeChoice::current_frame, "rotation"};
  if (evidence.tracks < options.track_share * evidence.average_tracks)
    return {KeyframeChoice::previous_frame, "few tracks"};
  const double fewest_mapped =
      std::min<double>(options.fewest_mapped, options.mapped_share * evidence.mapped_at_keyframe);
  if (evidence.mapped < fewest_mapped) return {KeyframeChoice::previous_frame, "few map points"};
  if (evidence.mean_displacement_px > options.displacement_share * image_width) {
    return {KeyframeChoice::current_frame, "displacement"};
  }
  const bool moved = evidence.mean_displacement_px > options.least_displacement_share * image_width;
  if (evidence.seconds >= options.interval_s && moved) return {KeyframeChoice::current_frame, "interval"};
  return {};
}

}  // namespace edgeslam
