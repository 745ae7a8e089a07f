// The image that says where a camera's images are not looked at.
#pragma once

#include <memory>
#include <string>

#include "geometry/camera_mask.h"

namespace edgeslam {

// Of any format that readGreyImage reads: what is black is masked. Throws InputError where it cannot be read or leaves
// nothing to look at.
std::shared_ptr<const CameraMask> readMask(const std::string& path);

// Why the mask cannot be that of the camera; empty where it can.
std::string maskSizeProblem(const CameraMask& mask, const Camera& camera);

// As a PNG file: black where it masks, white elsewhere.
std::string encodeMask(const CameraMask& mask);

}  // namespace edgeslam
