// The names of the files in a folder of TUM RGB-D's layout, as this program writes it: rgb.txt lists the frames in
// rgb/, camera.yaml has the calibration.
#pragma once

#include <cstdint>
#include <string>

#include "files/text_file.h"

namespace edgeslam {

constexpr const char* tum_list_name = "rgb.txt";
constexpr const char* tum_frames_name = "rgb";
constexpr const char* tum_camera_name = "camera.yaml";

// "1305031102.175304000.png", in rgb/.
inline std::string tumFrameName(std::int64_t time_ns) { return formatStamp(time_ns) + ".png"; }

}  // namespace edgeslam
