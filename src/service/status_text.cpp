#include "service/status_text.h"

namespace edgeslam {

std::string logText(TrackingState state, const std::string& reason) {
  if (isGoodPose(state)) return "tracking";
  if (state == TrackingState::predicted) return "";
  return stateName(state) + (reason.empty() ? "" : ", " + reason);
}

std::string serviceText(const PublisherStatus& status, TrackingState state, bool with_gaps) {
  if (!status.camera_problem.empty()) return "no camera: " + status.camera_problem;
  return std::string(stateName(state)) + ", " + std::to_string(status.keyframes) + " keyframes, " +
         std::to_string(status.points) + " points" +
         (status.worlds > 1 ? " in " + std::to_string(status.worlds) + " maps" : "") +
         (status.recording ? ", recording" : "") + (with_gaps ? " with gaps" : "");
}

}  // namespace edgeslam
