// The configuration and the calibration that frames bring with them, where the user gives no others.
#pragma once

#include <optional>
#include <string>

#include "configuration/configuration.h"
#include "frames/frame_source.h"

namespace edgeslam {

// Of the file; where `file` is empty, the one that a recording was made with, and the defaults for other frames. The
// lens of a video that brings its own times is presumed where there is no calibration, and looked for. Throws
// InputError as readConfiguration() does.
Configuration configurationFor(const FrameSource& source, const std::string& file);

// The configuration's calibration, or else the one beside the frames, as configured (asConfigured()). Throws
// InputError, which names `input`, where there is no calibration.
Camera cameraFor(const FrameSource& source, const Configuration& configuration, const std::string& input);

// What is to be told of that calibration where its distortion cannot be right; empty where nothing is. `beside`: the
// one beside the frames.
std::string calibrationDoubt(const std::optional<Camera>& beside, const Configuration& configuration);

}  // namespace edgeslam
