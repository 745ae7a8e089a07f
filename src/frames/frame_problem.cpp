#include "frames/frame_problem.h"

namespace edgeslam {

std::string frameProblem(const Frame& frame, const Camera& camera) {
  if (!frame.problem.empty()) return frame.problem;
  if (frame.grey.cols == camera.width && frame.grey.rows == camera.height) return "";
  return "image of " + std::to_string(frame.grey.cols) + " x " + std::to_string(frame.grey.rows) +
         " pixels, the calibration is for " + std::to_string(camera.width) + " x " + std::to_string(camera.height);
}

}  // namespace edgeslam
