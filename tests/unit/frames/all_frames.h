// What a source of frames gives until its end.
#pragma once

#include <optional>
#include <vector>

#include "frames/frame_source.h"

namespace edgeslam {

inline std::vector<Frame> readAll(FrameSource& source) {
  std::vector<Frame> frames;
  while (std::optional<Frame> frame = source.next()) frames.push_back(*frame);
  return frames;
}

}  // namespace edgeslam
