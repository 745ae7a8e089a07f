#include "recording/open_frame_source.h"

#include "recording/recording_source.h"

namespace edgeslam {

std::unique_ptr<FrameSource> openFrameSource(const std::string& path) {
  if (isRecording(path)) return std::make_unique<RecordingSource>(readRecording(path));
  return openFrames(path);
}

}  // namespace edgeslam
