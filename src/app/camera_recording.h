// Capture and writing of frames, each in its own thread, so that a disk that stalls does not stall the camera.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "drivers/frame_capture/live_camera.h"
#include "frames/frame_folder_writer.h"

namespace edgeslam {

struct CameraRecordingLimits {
  std::int64_t frames = 0;          // 0: without limit
  std::int64_t duration_ns = 0;     // of the time stamps, from the first frame's; 0: without limit
  std::size_t waiting_frames = 90;  // that the disk may be behind
};

struct CameraRecordingCounts {
  std::int64_t written = 0;
  std::int64_t lost_by_driver = 0;
  std::int64_t lost_by_disk = 0;  // the disk being too slow
  std::int64_t damaged = 0;
  std::int64_t interruptions = 0;
  std::int64_t duration_ns = 0;     // from the first frame's time stamp to the last one's
  std::int64_t arrival_stamps = 0;  // frames of which only the time of arrival is known
};

struct CameraRecordingResult {
  CameraRecordingCounts counts;
  std::string problem;  // why the disk took no more; empty otherwise
};

// Runs until a limit is reached, the camera ends, the disk takes no more, or `stop` is true. `tell` is given what a
// user should know, `progress` the counts after each frame; both are called by the calling thread.
CameraRecordingResult recordCamera(LiveCamera& camera, FrameFolderWriter& writer, const CameraRecordingLimits& limits,
                                   const std::function<bool()>& stop,
                                   const std::function<void(const std::string&)>& tell,
                                   const std::function<void(const CameraRecordingCounts&)>& progress);

}  // namespace edgeslam
