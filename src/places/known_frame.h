// What an inertial unit or wheels know of a world's frame, whatever is seen in it: how long its unit is, and which way
// is up. Neither drifts, so what is taken for a place seen before must not contradict them, and leaves them as they
// are: with both, only the turn about the vertical and the position are open (Qin et al. 2018, VINS-Mono, section
// VIII).
#pragma once

#include <optional>
#include <string>

#include "geometry/similarity.h"
#include "map/map.h"

namespace edgeslam {

struct KnownFrame {
  std::optional<double> metres_a_unit;
  std::optional<Eigen::Vector3d> up;  // unit, the world's frame
};

KnownFrame knownFrame(const Map& map, int world);

struct KnownFrameOptions {
  double largest_tilt_deg = 5;  // of the vertical of one against that of the other [deg]
  double largest_scale = 1.5;   // by which known lengths change, or its inverse: a loop's depths are rough
};

// Why `to_S_from` cannot be, in words: it tilts what is known to be upright, or changes known lengths. Empty where it
// can be, or nothing is known of one of both.
std::string contradiction(const KnownFrame& from, const KnownFrame& to, const Similarity& to_S_from,
                          const KnownFrameOptions& options);

// `to_S_from` with what is known of both frames put right; `place` [frame from] stays where it leads to.
Similarity putRight(const KnownFrame& from, const KnownFrame& to, const Similarity& to_S_from,
                    const Eigen::Vector3d& place);

}  // namespace edgeslam
