// The readout of the configuration or the calibration beside that of the camera's driver.
#pragma once

#include <string>

namespace edgeslam {

// A line for the log, or an empty text. `used_s`: what the run uses; 0: a global shutter. `is_configured`: the
// configuration gives it, so that a 0 is meant. `driver_s`: 0 where the driver does not tell.
std::string readoutLine(double used_s, bool is_configured, double driver_s);

}  // namespace edgeslam
