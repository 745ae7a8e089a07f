#include "drivers/frame_capture/pixel_format.h"

namespace edgeslam {
namespace {

struct FormatNames {
  PixelFormat format;
  const char* name;
  const char* code;  // four characters
};

constexpr FormatNames names[] = {
    {PixelFormat::grey, "GREY", "GREY"},   {PixelFormat::y10, "Y10", "Y10 "},     {PixelFormat::y12, "Y12", "Y12 "},
    {PixelFormat::y16, "Y16", "Y16 "},     {PixelFormat::nv12, "NV12", "NV12"},   {PixelFormat::nv21, "NV21", "NV21"},
    {PixelFormat::yu12, "YU12", "YU12"},   {PixelFormat::yuyv, "YUYV", "YUYV"},   {PixelFormat::uyvy, "UYVY", "UYVY"},
    {PixelFormat::mjpeg, "MJPEG", "MJPG"}, {PixelFormat::rgb24, "RGB24", "RGB3"}, {PixelFormat::bgr24, "BGR24", "BGR3"},
};

std::uint32_t codeOf(const char* text) {
  std::uint32_t code = 0;
  for (int i = 3; i >= 0; --i) code = code << 8 | static_cast<unsigned char>(text[i]);
  return code;
}

const FormatNames& namesOf(PixelFormat format) {
  for (const FormatNames& entry : names) {
    if (entry.format == format) return entry;
  }
  return names[0];
}

}  // namespace

const char* pixelFormatName(PixelFormat format) { return namesOf(format).name; }

std::optional<PixelFormat> pixelFormatOfName(const std::string& name) {
  for (const FormatNames& entry : names) {
    if (name == entry.name) return entry.format;
  }
  return std::nullopt;
}

std::uint32_t fourCharacterCode(PixelFormat format) { return codeOf(namesOf(format).code); }

std::optional<PixelFormat> pixelFormatOfCode(std::uint32_t code) {
  for (const FormatNames& entry : names) {
    if (code == codeOf(entry.code)) return entry.format;
  }
  if (code == codeOf("JPEG")) return PixelFormat::mjpeg;
  return std::nullopt;
}

std::size_t rowBytes(PixelFormat format, int width) {
  const std::size_t pixels = width > 0 ? static_cast<std::size_t>(width) : 0;
  switch (format) {
    case PixelFormat::grey:
    case PixelFormat::nv12:
    case PixelFormat::nv21:
    case PixelFormat::yu12:
      return pixels;
    case PixelFormat::y10:
    case PixelFormat::y12:
    case PixelFormat::y16:
      return 2 * pixels;
    case PixelFormat::yuyv:
    case PixelFormat::uyvy:
      return 4 * ((pixels + 1) / 2);  // two pixels share their colour
    case PixelFormat::rgb24:
    case PixelFormat::bgr24:
      return 3 * pixels;
    case PixelFormat::mjpeg:
      return 0;
  }
  return 0;
}

}  // namespace edgeslam
