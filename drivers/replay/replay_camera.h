// A recording, a folder of images or a video as a camera.
#pragma once

#include <functional>
#include <memory>

#include "drivers/frame_capture/live_camera.h"
#include "frames/frame_source.h"

namespace edgeslam {

struct ReplayPace {
  bool by_time_stamps = true;                  // each frame at its time; otherwise as fast as they are asked for
  std::function<std::int64_t()> now_ns;        // CLOCK_MONOTONIC
  std::function<void(std::int64_t)> sleep_ns;  // at least as long
};

// The frames of `source` with its time stamps and indices; none is left out, however late it is asked for. Unreadable
// frames are damaged frames. Its size is that of `size`, or, where that is empty, of the first frame that can be read;
// others are damaged frames. A problem where no frame can be read.
OpenedCamera openReplayCamera(std::unique_ptr<FrameSource> source, const std::string& name, cv::Size size,
                              const ReplayPace& pace);

}  // namespace edgeslam
