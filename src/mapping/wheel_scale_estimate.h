// How many metres the map's unit is, by the wheels, from the keyframes as they are: what the wheels say of each stretch
// of the camera's way over the same in map units.
#pragma once

#include <string>

#include "map/map.h"
#include "wheels/wheel_motion.h"

namespace edgeslam {

struct WheelScaleOptions {
  double stretch_m = 0.06;      // of the camera's way, by the wheels: shorter ones are joined
  int fewest_stretches = 3;     // that agree
  double largest_sigma = 0.06;  // the scale is known when its standard deviation is below this share of it
  double shared_sigma = 0.02;   // of all the wheels' ways: the size of the wheels, as a share
};

struct WheelScaleEstimate {
  WheelScale scale;
  std::string lacking;  // why it is not known, in words that a user understands; empty: it is
};

// Of a world.
WheelScaleEstimate estimateWheelScale(const WheelOptions& wheels, const WheelScaleOptions& options, const Map& map,
                                      int world);

}  // namespace edgeslam
