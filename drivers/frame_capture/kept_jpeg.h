// Frames as a motion-JPEG camera sent them, for the flight recorder, which can do without packing them itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "drivers/frame_capture/pixel_format.h"
#include "image_formats/jpeg_decoder.h"
#include "tracking/recycling_pool.h"

namespace edgeslam {

// For capture's thread; what it gives may be let go in any.
class KeptJpeg {
 public:
  void keep(bool keep) { keeps_ = keep; }

  // A copy of a driver's buffer; null where it is no JPEG, or nobody wants it. Takes memory only until there is enough
  // for all frames that wait.
  CameraJpeg of(PixelFormat format, const std::uint8_t* data, std::size_t size) {
    if (!keeps_ || format != PixelFormat::mjpeg) return nullptr;
    std::shared_ptr<std::vector<unsigned char>> copy = files_.take();
    copy->assign(data, data + size);
    return copy;
  }

 private:
  RecyclingPool<std::vector<unsigned char>> files_{[](std::vector<unsigned char>& /*file*/) {}};
  bool keeps_ = false;
};

}  // namespace edgeslam
