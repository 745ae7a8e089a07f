// How the inertial unit is turned against the camera where that is not as it was given: looked for now and then while
// the camera turns, and taken where several looks say the same.
#pragma once

#include <optional>
#include <vector>

#include "inertia/found_unit_rotation.h"
#include "mapping/unit_rotation_estimate.h"

namespace edgeslam {

class UnitRotationFinding {
 public:
  // With the rotation that was given.
  explicit UnitRotationFinding(const InertialUnit& unit) : unit_(unit) {}

  // With each keyframe: the frames in a row up to it, what was felt meanwhile, and how the clocks differ as far as is
  // known. True where the rotation is another one now.
  bool look(const std::vector<PosedCamera>& frames, const std::vector<InertialSample>& samples, std::int64_t offset_ns);

  // None: it is as given, as far as is known.
  const std::optional<FoundUnitRotation>& found() const { return found_; }
  // The latest change was so large that it tells in the map.
  bool bendsMap() const { return bends_map_; }
  // What is too far from what was given to be an error of it, and is not used [rad]; 0: nothing is.
  double tooFar() const { return too_far_; }

 private:
  bool isToChange(const UnitRotationEstimate& estimate);

  InertialUnit unit_;
  std::optional<FoundUnitRotation> found_;
  std::int64_t looked_ns_ = -1;                      // at frames up to this time
  int agreeing_ = 0;                                 // looks in a row, that say that it is another one ...
  Eigen::Vector3d last_ = Eigen::Vector3d::Zero();   // ... and which, as UnitRotationEstimate::change ...
  Eigen::Vector3d taken_ = Eigen::Vector3d::Zero();  // ... and that which was found
  bool bends_map_ = false;
  double too_far_ = 0;
};

}  // namespace edgeslam
