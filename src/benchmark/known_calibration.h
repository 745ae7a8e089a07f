// The published calibrations of data sets whose folders come without one: TUM RGB-D and ICL-NUIM, by the sequence's
// name.
#pragma once

#include <optional>
#include <string>

#include "geometry/camera.h"

namespace edgeslam {

// By a sequence's name or the path of its folder: "rgbd_dataset_freiburg2_desk", "fr1_xyz", "office0",
// "living_room_traj2_frei_png". The values are those of firmware_cfg/cameras. Nothing for any other name.
std::optional<Camera> knownCalibration(const std::string& sequence);

}  // namespace edgeslam
