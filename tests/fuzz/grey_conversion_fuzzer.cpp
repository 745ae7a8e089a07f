// Buffers as a broken camera could fill them: any bytes, in any format and layout, never more than are there.
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "drivers/frame_capture/grey_conversion.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edgeslam;
  if (size < 8) return 0;
  // The first bytes choose format, size and stride; the rest is the buffer.
  const PixelFormat format = pixel_formats[data[0] % std::size(pixel_formats)];
  BufferLayout layout{format, data[1] + 1, data[2] + 1, 0};
  if (data[3] < 128) layout.stride = data[3] * 9U;
  if (data[3] == 255) layout.stride = SIZE_MAX / (data[4] + 1U);
  if (data[3] == 254) layout.width = -layout.width;
  if (data[3] == 253) layout.height = 1 << (data[4] % 31);
  if (format == PixelFormat::mjpeg && data[3] < 250) {  // mostly the size that a JPEG has
    layout.width = 16 * (1 + data[1] % 4);
    layout.height = 16 * (1 + data[2] % 4);
  }
  const std::vector<std::uint8_t> buffer(data + 8, data + size);

  static JpegDecoder jpeg;
  cv::Mat grey;
  const std::string problem = convertToGrey(layout, buffer.data(), buffer.size(), jpeg, grey);
  // What is called good fills the image, whose every pixel can be read.
  if (problem.empty()) {
    if (grey.cols != layout.width || grey.rows != layout.height || grey.type() != CV_8U) std::abort();
    std::uint64_t sum = 0;
    for (int y = 0; y < grey.rows; ++y) {
      for (int x = 0; x < grey.cols; ++x) sum += grey.ptr(y)[x];
    }
    if (sum > std::uint64_t{255} * grey.total()) std::abort();
  }
  return 0;
}
