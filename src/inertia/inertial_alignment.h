// How a map lies to the earth, by what an inertial unit felt while the map was made.
#pragma once

#include "geometry/similarity.h"
#include "inertia/inertial_unit.h"

namespace edgeslam {

// Errors of keyframes hang together, and bend the map: what is found of it is known so many times less well than they
// say.
constexpr double honest_times = 2;

// Standard deviations of biases that are not known yet, each axis.
constexpr double unknown_rate_bias = 0.1;   // [rad/s]
constexpr double unknown_force_bias = 0.3;  // [m/s^2]

struct InertialAlignment {
  InertialBias bias;                                  // of the unit, lately
  double rate_bias_sigma = unknown_rate_bias;         // standard deviation, each axis [rad/s]
  bool is_bias_known = false;                         // in this run: a unit that is switched on has others
  bool is_known = false;                              // else all that follows means nothing
  double metres_a_unit = 1;                           // of the map
  double scale_sigma = 0;                             // standard deviation of it, share of it
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  // the map's frame [m/s^2], standard_gravity long
  double force_bias_sigma = 0;                        // standard deviation, each axis [m/s^2]
  double adjusted_scale_sigma = 1;                    // as scale_sigma, when it was last adjusted with the map
};

// Turns the map's frame so that z is up, about the horizontal axis that does it with the least turn.
Eigen::Quaterniond uprightRotation(const InertialAlignment& alignment);

// The same of a map that was moved.
InertialAlignment moved(const Similarity& new_S_old, const InertialAlignment& alignment);

}  // namespace edgeslam
