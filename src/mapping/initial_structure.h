// P14: a structure of the first frame's points and the poses of some frames since, adjusted together.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/camera.h"
#include "mapping/initial_frames.h"
#include "mapping/initialisation_options.h"

namespace edgeslam {

// Where an adjustment begins.
struct InitialStart {
  std::string method;                  // "flat start", "five-point", "forward start", "rightward start", ...
  std::vector<std::size_t> frames;     // indices into InitialFrames::since, ascending; the last is the current one
  std::vector<Pose> first_T_camera;    // one for each of these; in units of the points' median distance
  std::vector<double> inverse_depths;  // one a point of the first frame, along its bearing
};

struct InitialStructure : InitialStart {
  std::vector<double> depth_sigmas;  // standard deviations of the inverse depths
  double error = 0;  // mean whitened squared error of all observations, each bounded by the outlier limit

  // Whether a point's inverse depth is known better than to this share of it.
  bool isKnown(std::size_t point, double largest_sigma) const {
    return inverse_depths[point] > 0 && !(depth_sigmas[point] > largest_sigma * inverse_depths[point]);
  }
};

// Bundle adjustment of all points and the start's frames, then again without the outliers; the first frame's pose is
// fixed. Nothing where an adjustment fails.
std::optional<InitialStructure> adjustInitialStructure(const Camera& camera, const InitialFrames& frames,
                                                       InitialStart start, const InitialisationOptions& options);

// Where the ray of a point of the first frame begins, in its camera frame: not the centre where the camera moved as it
// read the point's row.
Eigen::Vector3d rayOrigin(const Camera& camera, const TrackedFrame& first, const PointObservation& point);

// Pose first_T_camera of a frame that sees the first one's points, adjusted from a pose near it. Points with an inverse
// depth that is not positive are left out. Nothing where the adjustment does not converge.
std::optional<Pose> locateAgainst(const Camera& camera, const TrackedFrame& first,
                                  const std::vector<double>& inverse_depths, const TrackedFrame& frame,
                                  const Pose& near);

}  // namespace edgeslam
