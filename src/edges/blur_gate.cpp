#include "edges/blur_gate.h"

namespace edgeslam {

double sharpness(const cv::Mat& grey, const EdgeMap& edges) {
  if (grey.empty()) return 0;
  double sum = 0;
  for (const EdgePoint& point : edges.points) sum += static_cast<double>(point.gradient);
  return sum / static_cast<double>(grey.total());
}

bool isBlurred(BlurGate& gate, double frame_sharpness, const BlurGateOptions& options) {
  const bool blurred = !(frame_sharpness > 0) || frame_sharpness < options.share_of_average * gate.average;
  if (blurred) {
    if (++gate.rejected_in_a_row >= options.longest_rejection) gate = {};
    return true;
  }
  gate.rejected_in_a_row = 0;
  gate.average = gate.average > 0 ? options.forgetting * gate.average + (1 - options.forgetting) * frame_sharpness
                                  : frame_sharpness;
  return false;
}

}  // namespace edgeslam
