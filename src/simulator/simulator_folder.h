// Simulated sequences as folders in TUM layout, which openFrameSource reads.
#pragma once

#include <functional>
#include <string>

#include "simulator/simulator.h"

namespace edgeslam {

// Text of camera.yaml.
std::string formatCalibration(const Camera& camera, const SimulationOptions& options);

// Writes rgb/*.png, rgb.txt, groundtruth.txt, camera.yaml and surfaces.txt to `folder`, and imu.csv and imu.yaml where
// the options ask for them, all of it or, on failure, nothing. A folder that is not empty is refused unless `force`,
// which replaces files of these names. `progress` is called after each frame with the number of frames done. Throws
// InputError with path and reason.
void writeSequence(const SimulatedSequence& sequence, const std::string& folder, bool force,
                   const std::function<void(int)>& progress);

}  // namespace edgeslam
