// How many metres a map's unit is, by the wheels.
#pragma once

namespace edgeslam {

struct WheelScale {
  bool is_known = false;  // else what follows means nothing
  double metres_a_unit = 1;
  double sigma = 0;  // standard deviation of it, share of it
};

}  // namespace edgeslam
