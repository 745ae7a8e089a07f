// What the wheels say of neighbouring keyframes, for their adjustment: how they are turned against each other and, once
// the map's scale is known, where they are (adjustment/bundle_inertia.h).
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "adjustment/bundle_adjustment.h"
#include "map/map.h"
#include "wheels/wheel_motion.h"

namespace edgeslam {

// From a keyframe to the next one of its world; none where the wheels do not tell it, or they slipped: what they say is
// out of all proportion to how the keyframes lie now. `scale`: of the world.
std::optional<WheelMotion> motionToNext(const WheelOptions& options, const WheelScale& scale, const Keyframe& keyframe,
                                        const Keyframe& next);

// The inertial unit's gyroscope beside the wheels.
struct GyroscopeBeside {
  Eigen::Quaterniond camera_R_imu = Eigen::Quaterniond::Identity();
  InertialBias bias;
};

// Adds what is known between neighbours of which one is free. Where a gyroscope tells the turn, too, the wheels' counts
// less, and what turns otherwise has slipped: nothing of it counts. Keyframes that are not in the problem yet,
// `camera_of` adds, as fixed ones.
void addWheelTerms(const WheelOptions& options, const WheelScale& scale,
                   const std::optional<GyroscopeBeside>& gyroscope, const Map& map, const std::vector<KeyframeId>& free,
                   const std::function<int(KeyframeId)>& camera_of, BundleProblem& problem);

}  // namespace edgeslam
