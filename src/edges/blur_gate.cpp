#include "edges/blur_gate.h"

namespace edgeslam {

double sharpness(const cv::Mat& grey, const EdgeMap& edges) {
  if (grey.empty()) return 0;
  double sum = 0;
  for (const EdgePoint& point : edges.points) sum += static_cast<double>(point.gradient);
  return sum / static_cast<double>(grey.total());
}

bool isBlurred(BlurGate& gate, const FrameSharpness& frame, const BlurGateOptions& options) {
  if (gate.rejected_since_ns >= 0) {
    const double rejected_s = static_cast<double>(frame.time_ns - gate.rejected_since_ns) * 1e-9;
    if (rejected_s >= options.longest_rejection_s) gate.average = 0;
  }
  if (!(frame.value > 0) || frame.value < options.share_of_average * gate.average) {
    if (gate.rejected_since_ns < 0) gate.rejected_since_ns = frame.time_ns;
    return true;
  }
  gate.rejected_since_ns = -1;
  gate.average =
      gate.average > 0 ? options.forgetting * gate.average + (1 - options.forgetting) * frame.value : frame.value;
  return false;
}

}  // namespace edgeslam
