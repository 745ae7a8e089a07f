// What an inertial unit on the simulated camera would measure: along the exact motion, with the noise and the biases of
// a small part.
#pragma once

#include <vector>

#include "inertia/inertial_unit.h"
#include "simulator/simulator.h"

namespace edgeslam {

constexpr double simulated_inertial_rate_hz = 200;

// The unit that is simulated: some centimetres beside the camera, its x upwards.
InertialUnit simulatedUnit();

// From the first frame to just after the last one, every 1 / simulated_inertial_rate_hz seconds.
std::vector<InertialSample> simulateInertia(const SimulatedSequence& sequence);

// Texts of imu.yaml and imu.csv (frames/inertial_file.h).
std::string formatInertialUnit(const InertialUnit& unit);
std::string formatInertialSamples(const std::vector<InertialSample>& samples);

}  // namespace edgeslam
