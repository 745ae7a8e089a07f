// The pixel formats that can be turned to grey, by their V4L2 names.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace edgeslam {

enum class PixelFormat { grey, y10, y12, y16, nv12, nv21, yu12, yuyv, uyvy, mjpeg, rgb24, bgr24 };

// From the least work to the most, all of them.
constexpr PixelFormat pixel_formats[] = {PixelFormat::grey, PixelFormat::nv12,  PixelFormat::nv21,  PixelFormat::yu12,
                                         PixelFormat::y10,  PixelFormat::y12,   PixelFormat::y16,   PixelFormat::yuyv,
                                         PixelFormat::uyvy, PixelFormat::mjpeg, PixelFormat::bgr24, PixelFormat::rgb24};

// "GREY", "Y10", "Y12", "Y16", "NV12", "NV21", "YU12", "YUYV", "UYVY", "MJPEG", "RGB24", "BGR24". RGB24 has red in the
// first byte.
const char* pixelFormatName(PixelFormat format);
std::optional<PixelFormat> pixelFormatOfName(const std::string& name);

// The four characters by which V4L2 knows it, the first in the lowest byte.
std::uint32_t fourCharacterCode(PixelFormat format);
std::optional<PixelFormat> pixelFormatOfCode(std::uint32_t code);

// Bytes that the brightness of a row takes, without padding; 0 for MJPEG.
std::size_t rowBytes(PixelFormat format, int width);

}  // namespace edgeslam
