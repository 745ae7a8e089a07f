// Frames from whatever a user names: a recording of the flight recorder, or a folder or video as openFrames knows them.
#pragma once

#include <memory>
#include <string>

#include "frames/frame_source.h"

namespace edgeslam {

// Throws InputError as openFrames() and readRecording() do.
std::unique_ptr<FrameSource> openFrameSource(const std::string& path);

}  // namespace edgeslam
