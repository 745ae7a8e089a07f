// How an inertial unit sits on a camera, and how their clocks differ, from any recording in which the camera turned: by
// comparing how it turned in its map with what the gyroscope felt.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/force_fit.h"
#include "inertia/camera_turns.h"
#include "inertia/inertial_unit.h"
#include "inertia/turn_fit.h"

namespace edgeslam {

struct InertialCalibration {
  std::string problem;             // why the recording does not say; empty where it does
  TurnFit fit;                     // means nothing where there is a problem
  double turn_s = 0;               // how long the turns of `fit` last
  std::optional<ForceFit> forces;  // none where the camera's way says nothing of them
  std::string unchecked;           // what it could not tell all the same, for people; empty: nothing
};

// Times of `poses` ascend, and those of `samples`; there are some of both. Of what is known of the unit count its
// offset, to half a second, where it is, to some centimetres, and how its gyroscope's bias walks.
InertialCalibration calibrateInertialUnit(const std::vector<PosedCamera>& poses,
                                          const std::vector<InertialSample>& samples, const InertialUnit& known);

// The unit with rotation and offset as they were found.
InertialUnit unitWith(const InertialUnit& known, const TurnParameters& found);

// Standard deviations of a fit.
Eigen::Vector3d rotationSigma(const TurnFit& fit);  // about the camera's x, y and z [rad]
Eigen::Vector3d biasSigma(const TurnFit& fit);      // the unit's frame [rad/s]
double offsetSigma(const TurnFit& fit);             // [s]

}  // namespace edgeslam
