// Whether an inertial unit moves against the camera that it should be fixed to: then the gyroscope turns where the
// camera does not, again and again, whatever the clocks' offset, the unit's rotation and its bias are.
#pragma once

#include <cstdint>
#include <vector>

#include "inertia/camera_turns.h"
#include "inertia/inertial_unit.h"

namespace edgeslam {

class LooseUnitCheck {
 public:
  // With each keyframe: the frames in a row up to it, what was felt meanwhile, and the unit as far as is known. True
  // once it is loose, and from then on.
  bool look(const std::vector<PosedCamera>& frames, const std::vector<InertialSample>& samples,
            const InertialUnit& unit);

  bool isLoose() const { return loose_looks_ >= looks_in_a_row; }
  // Of the latest look: the turns in which it moved, as a share, and by how much at most [rad].
  double share() const { return share_; }
  double largest() const { return largest_; }

  // So far back a look goes.
  static constexpr std::int64_t looked_back_ns = 10'000'000'000;

 private:
  static constexpr int looks_in_a_row = 3;

  std::int64_t looked_ns_ = -1;  // at frames up to this time
  int loose_looks_ = 0;          // in a row
  double share_ = 0, largest_ = 0;
};

}  // namespace edgeslam
