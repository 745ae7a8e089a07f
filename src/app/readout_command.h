// `edgeslam calibrate --readout RECORDING`: the readout of a rolling shutter from any recording with motion.
#pragma once

#include <string>

namespace edgeslam {

// Prints the readout with its standard deviation. Returns an exit code: that of failure where the recording does not
// say. Throws InputError where it cannot be read, or there is no calibration for it.
int findReadout(const std::string& recording, const std::string& configuration_file);

}  // namespace edgeslam
