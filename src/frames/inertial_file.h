// What an inertial unit measured beside recorded frames: imu.csv with imu.yaml, and EuRoC's imu0.
#pragma once

#include <string>
#include <vector>

#include "inertia/inertial_unit.h"

namespace edgeslam {

// Paths of what lies beside the frames; empty where there is none.
struct InertialFiles {
  std::string samples;       // imu.csv, or EuRoC's imu0/data.csv
  std::string unit;          // imu.yaml, or EuRoC's imu0/sensor.yaml
  std::string euroc_camera;  // EuRoC's cam0/sensor.yaml, which has the camera's place on the body
};

struct InertialRecording {
  InertialUnit unit;
  std::vector<InertialSample> samples;  // time stamps ascend
};

// Lines of time stamp [s, or whole ns], rate x y z [rad/s], specific force x y z [m/s^2], parted by commas or blanks; a
// last line that a power cut tore is left out. Throws InputError with file and line where one is none, or its time
// stamp not after the one before, and where all of it must be in other units: degrees, or multiples of g.
std::vector<InertialSample> readInertialSamples(const std::string& path);

// Likewise, of what lies beside frames; throws InputError where nothing does.
std::vector<InertialSample> readInertialSamples(const InertialFiles& files);

// imu.yaml: imu_T_camera {translation [m], quaternion w x y z}, and, where they differ from the defaults,
// gyroscope_noise_density, gyroscope_random_walk, accelerometer_noise_density, accelerometer_random_walk (Kalibr's
// units), time_offset_s (Kalibr's timeshift_cam_imu: what is added to a frame's time for the unit's clock), readout_s
// (of the camera, as in its calibration), rate_hz. Throws InputError.
InertialUnit readInertialUnit(const std::string& path);

// Throws InputError where there is none, or one of the files cannot be used.
InertialRecording readInertialRecording(const InertialFiles& files);

}  // namespace edgeslam
