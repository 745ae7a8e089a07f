#include "pipeline/run_result.h"

namespace edgeslam {

const char* stateName(TrackingState state) {
  switch (state) {
    case TrackingState::initialising:
      return "initialising";
    case TrackingState::tracking:
      return "tracking";
    case TrackingState::predicted:
      return "predicted";
    case TrackingState::recovered:
      return "recovered";
    case TrackingState::relocalised:
      return "relocalised";
    case TrackingState::lost:
      return "lost";
  }
  return "unknown";
}

}  // namespace edgeslam
