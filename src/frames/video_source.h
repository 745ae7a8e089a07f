// Frames of a video file, timed by a list of stamps beside it or by the video itself.
#pragma once

#include <memory>
#include <string>

#include "frames/folder_source.h"

namespace edgeslam {

// True for the customary extensions of video files.
bool isVideoFileName(const std::string& name);

// One time stamp [s] a line for each frame, in order; the video's own timing is not looked at. Throws InputError where
// stamps are no numbers, go back or repeat (with line), or the video cannot be opened. At the end of the video next()
// throws InputError where the numbers of frames and stamps differ.
std::unique_ptr<FrameSource> makeStampedVideoSource(const std::string& video_path, const std::string& times_path,
                                                    FrameCompanions companions);

// Timed by the video's presentation times, or by its frame rate where these do not increase; the first frame is at 0 or
// later. Throws InputError where the video cannot be opened or has no timing.
std::unique_ptr<FrameSource> makeVideoSource(const std::string& video_path, FrameCompanions companions);

}  // namespace edgeslam
