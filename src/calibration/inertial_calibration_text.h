// What was found of an inertial unit as text: the file that the program reads, and what people are told.
#pragma once

#include <string>

#include "calibration/inertial_calibration.h"

namespace edgeslam {

// The unit as it was known before: where it sits, its noise, its clock.
struct KnownUnit {
  InertialUnit unit;
  bool has_place = false;  // else unit.imu_T_camera means nothing
};

// imu.yaml, which readInertialUnit reads, with standard deviations in comments. `source`: of the frames.
std::string inertialUnitText(const KnownUnit& known, const InertialCalibration& calibration, const std::string& source);

// The result for people, several lines.
std::string inertialSummary(const KnownUnit& known, const InertialCalibration& calibration);

}  // namespace edgeslam
