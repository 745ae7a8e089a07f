// `edgeslam calibrate --imu INPUT`: how an inertial unit sits on the camera, and how their clocks differ, from a
// recording with motion.
#pragma once

#include <string>

namespace edgeslam {

struct InertialCommand {
  std::string input;
  std::string configuration;  // path; empty: none
  std::string board;          // as parseBoard() takes it; empty: poses are those in the map that a run makes
  std::string output;         // imu.yaml to write; empty: none
  bool force = false;         // replaces it
};

// Prints what it finds with standard deviations. Returns an exit code: that of failure where the recording does not
// say. Throws InputError where it cannot be read, or a calibration of the camera or inertial data are missing.
int calibrateUnit(const InertialCommand& command);

}  // namespace edgeslam
