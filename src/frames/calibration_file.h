// Camera calibrations: our camera.yaml, ROS camera_info, Kalibr camera chains and EuRoC's sensor.yaml.
#pragma once

#include <string>

#include "geometry/camera.h"

namespace edgeslam {

// What a calibration may say: far beyond every camera, and within what a saved map takes (map/map_check.h). Images are
// of 1 to largest_camera_side pixels, and readouts of -longest_readout_s to longest_readout_s.
constexpr double least_focal_length_px = 1e-3, largest_focal_length_px = 1e6;
constexpr double largest_distortion = 1e6;  // of a coefficient, either sign

// Recognised by their keys:
//  - ours: width height fx fy cx cy k1 k2 p1 p2 [k3] [fps] [board_cols board_rows board_square]
//    [model: pinhole_radial_tangential | kannala_brandt, the latter with k1 k2 k3 k4] [readout, in s]; missing
//    distortion is 0, and so is a missing readout
//  - ROS camera_info: image_width image_height camera_matrix distortion_model (plumb_bob, rational_polynomial whose
//    denominator is 1, equidistant) distortion_coefficients
//  - Kalibr: cam0 (others are not read) with camera_model pinhole, distortion_model radtan | equidistant | none
//    [line_delay, from row to row, in s]
//  - EuRoC: camera_model pinhole, distortion_model radial-tangential | equidistant
// Throws InputError with file, line and key where the file is missing or no YAML, a key is missing, unknown (ours) or
// twice there, a value has the wrong type, is not finite or impossible: out of the ranges above, centre outside the
// image.
Camera readCalibration(const std::string& path);

// Text of a camera.yaml; readCalibration gives back the same camera to the last bit.
std::string formatCalibrationFile(const Camera& camera);

}  // namespace edgeslam
