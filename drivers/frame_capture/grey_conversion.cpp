#include "drivers/frame_capture/grey_conversion.h"

#include <algorithm>
#include <cstring>

namespace edgeslam {
namespace {

using Byte = std::uint8_t;

// Every second byte: the brightness of YUYV (from byte 0) and UYVY (from byte 1), the upper half of little-endian Y16.
void takeEverySecond(const Byte* from, Byte* to, int width) {
  for (int x = 0; x < width; ++x) to[x] = from[2 * x];
}

void takeUpperBits(const Byte* from, Byte* to, int width, int bits) {
  for (int x = 0; x < width; ++x) {
    const int value = (from[2 * x] | from[2 * x + 1] << 8) >> (bits - 8);
    to[x] = static_cast<Byte>(std::min(value, 255));
  }
}

// ITU-R BT.601, in 1/65536.
void weighColours(const Byte* from, Byte* to, int width, int red, int blue) {
  for (int x = 0; x < width; ++x) {
    const Byte* const pixel = from + 3 * x;
    to[x] = static_cast<Byte>((19595 * pixel[red] + 38470 * pixel[1] + 7471 * pixel[blue] + 32768) >> 16);
  }
}

void convertRow(PixelFormat format, const Byte* from, Byte* to, int width) {
  switch (format) {
    case PixelFormat::grey:
    case PixelFormat::nv12:
    case PixelFormat::nv21:
    case PixelFormat::yu12:  // the brightness comes first
      std::memcpy(to, from, static_cast<std::size_t>(width));
      break;
    case PixelFormat::y10:
      takeUpperBits(from, to, width, 10);
      break;
    case PixelFormat::y12:
      takeUpperBits(from, to, width, 12);
      break;
    case PixelFormat::yuyv:
      takeEverySecond(from, to, width);
      break;
    case PixelFormat::y16:
    case PixelFormat::uyvy:
      takeEverySecond(from + 1, to, width);
      break;
    case PixelFormat::rgb24:
      weighColours(from, to, width, 0, 2);
      break;
    case PixelFormat::bgr24:
      weighColours(from, to, width, 2, 0);
      break;
    case PixelFormat::mjpeg:
      break;
  }
}

}  // namespace

std::string convertToGrey(const BufferLayout& layout, const std::uint8_t* data, std::size_t size, JpegDecoder& jpeg,
                          cv::Mat& grey) {
  if (layout.width < 1 || layout.height < 1 || layout.width > largest_image_side ||
      layout.height > largest_image_side) {
    return "an impossible size of " + std::to_string(layout.width) + " x " + std::to_string(layout.height) + " pixels";
  }
  grey.create(layout.height, layout.width, CV_8U);
  if (layout.format == PixelFormat::mjpeg) return jpeg.decode(data, size, grey);

  const std::size_t row = rowBytes(layout.format, layout.width);
  const std::size_t stride = layout.stride == 0 ? row : layout.stride;
  const std::size_t rows_before = static_cast<std::size_t>(layout.height) - 1;
  if (stride < row) {
    return "rows of " + std::to_string(stride) + " bytes, a row takes " + std::to_string(row);
  }
  // Compared by division, as a stride from outside can make the product overflow.
  if (size < row || (rows_before > 0 && (size - row) / rows_before < stride)) {
    return "cut off: " + std::to_string(size) + " bytes are too few for " + std::to_string(layout.height) +
           " rows of " + std::to_string(stride) + " bytes";
  }
  for (int y = 0; y < layout.height; ++y) {
    convertRow(layout.format, data + stride * static_cast<std::size_t>(y), grey.ptr(y), layout.width);
  }
  return "";
}

}  // namespace edgeslam
