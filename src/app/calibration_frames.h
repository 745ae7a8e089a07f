// Frames for a calibration, from a recording or a live camera, until there are enough views.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "calibration/view_selection.h"
#include "drivers/frame_capture/live_camera.h"
#include "frames/frame_source.h"
#include "recording/open_frame_source.h"

namespace edgeslam {

// The frames of a folder, video or recording as openFrameSource() has them; besides, a folder of images with any names,
// as stills in the order of their names. Throws InputError as openFrameSource() does.
std::unique_ptr<FrameSource> openStillsOrFrames(const std::string& path);

using TellLine = std::function<void(const std::string&)>;

// Takes views from all frames. `tell` is given the guidance, a line at a time. Throws InputError where more than a
// fifth of the frames cannot be read.
void takeViews(FrameSource& source, const Board& board, ViewSelection& selection, const TellLine& tell);

// Takes views until nothing is missing any more, `stop` is true, the camera ends, or the time is up (0: no limit).
void takeViews(LiveCamera& camera, const Board& board, double seconds, ViewSelection& selection,
               const std::function<bool()>& stop, const TellLine& tell);

}  // namespace edgeslam
