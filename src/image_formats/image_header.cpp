#include "image_formats/image_header.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>

namespace edgeslam {
namespace {

using namespace std::string_view_literals;

// Unsigned numbers at any place; none beyond the end.
class Numbers {
 public:
  Numbers(std::string_view bytes, bool little_endian) : bytes_(bytes), little_endian_(little_endian) {}

  std::optional<std::int64_t> at(std::size_t offset, std::size_t size) const {
    if (offset > bytes_.size() || bytes_.size() - offset < size) return std::nullopt;
    std::int64_t number = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t place = offset + (little_endian_ ? size - 1 - i : i);
      number = number << 8 | static_cast<unsigned char>(bytes_[place]);
    }
    return number;
  }

  std::optional<ClaimedSize> sizeAt(std::size_t width_offset, std::size_t height_offset, std::size_t size) const {
    const auto width = at(width_offset, size), height = at(height_offset, size);
    if (!width || !height) return std::nullopt;
    return ClaimedSize{*width, *height};
  }

 private:
  std::string_view bytes_;
  bool little_endian_;
};

// Its IHDR comes first.
std::optional<ClaimedSize> sizeInPng(std::string_view bytes) {
  if (bytes.size() < 16 || bytes.substr(12, 4) != "IHDR") return std::nullopt;
  return Numbers(bytes, false).sizeAt(16, 20, 4);
}

// The first frame header (SOF) in the walk over its segments.
std::optional<ClaimedSize> sizeInJpeg(std::string_view bytes) {
  const Numbers numbers(bytes, false);
  std::size_t at = 2;
  while (at + 1 < bytes.size()) {
    const auto marker = static_cast<unsigned char>(bytes[at + 1]);
    const bool is_marker = bytes[at] == '\xFF' && marker != 0x00 && marker != 0xFF;
    if (!is_marker) {
      ++at;
      continue;
    }
    const bool is_frame = marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
    if (is_frame) return numbers.sizeAt(at + 7, at + 5, 2);
    const bool stands_alone = marker == 0x01 || (marker >= 0xD0 && marker <= 0xD8);
    const auto length = numbers.at(at + 2, 2);
    if (!stands_alone && !length) return std::nullopt;
    at += 2 + (stands_alone ? 0 : static_cast<std::size_t>(*length));
  }
  return std::nullopt;
}

// Two decimal numbers after "P5", parted by blanks and comments.
std::optional<ClaimedSize> sizeInNetpbm(std::string_view bytes) {
  constexpr std::int64_t too_many = 1'000'000'000;
  std::size_t at = 2;
  const auto next = [&]() -> std::optional<std::int64_t> {
    while (at < bytes.size() && !std::isdigit(static_cast<unsigned char>(bytes[at]))) {
      const bool is_comment = bytes[at] == '#';
      at = is_comment ? std::min(bytes.find('\n', at), bytes.size()) : at + 1;
    }
    if (at == bytes.size()) return std::nullopt;
    std::int64_t number = 0;
    for (; at < bytes.size() && std::isdigit(static_cast<unsigned char>(bytes[at])); ++at) {
      number = std::min(number * 10 + (bytes[at] - '0'), too_many);
    }
    return number;
  };
  const auto width = next(), height = next();
  if (!width || !height) return std::nullopt;
  return ClaimedSize{*width, *height};
}

struct Format {
  ImageFormat format;
  std::string_view beginning;
  std::optional<ClaimedSize> (*size)(std::string_view bytes);
};

constexpr std::array<Format, 4> formats{{{ImageFormat::png, "\x89PNG\r\n\x1a\n"sv, sizeInPng},
                                         {ImageFormat::jpeg, "\xFF\xD8\xFF"sv, sizeInJpeg},
                                         {ImageFormat::pgm, "P5"sv, sizeInNetpbm},
                                         {ImageFormat::ppm, "P6"sv, sizeInNetpbm}}};

struct OtherFormat {
  std::string_view beginning, name;
};

constexpr std::array<OtherFormat, 9> other_formats{{{"BM"sv, "a BMP image"sv},
                                                    {"II*\0"sv, "a TIFF image"sv},
                                                    {"MM\0*"sv, "a TIFF image"sv},
                                                    {"RIFF"sv, "a WebP image or a film"sv},
                                                    {"GIF8"sv, "a GIF image"sv},
                                                    {"P1"sv, "a PBM image"sv},
                                                    {"P4"sv, "a PBM image"sv},
                                                    {"P2"sv, "a PGM image in decimal digits"sv},
                                                    {"P3"sv, "a PPM image in decimal digits"sv}}};

const Format* formatOf(std::string_view bytes) {
  const auto* format = std::find_if(formats.begin(), formats.end(), [&](const Format& f) {
    return bytes.substr(0, f.beginning.size()) == f.beginning;
  });
  return format == formats.end() ? nullptr : format;
}

}  // namespace

std::optional<ImageFormat> imageFormat(std::string_view bytes) {
  const Format* format = formatOf(bytes);
  return format ? std::optional(format->format) : std::nullopt;
}

std::string otherImageFormat(std::string_view bytes) {
  for (const auto& [beginning, name] : other_formats) {
    if (bytes.substr(0, beginning.size()) == beginning) return std::string(name);
  }
  return "";
}

std::optional<ClaimedSize> claimedSize(std::string_view bytes) {
  const Format* format = formatOf(bytes);
  return format ? format->size(bytes) : std::nullopt;
}

bool canHoldItsSize(std::string_view bytes) {
  constexpr double most_inflated = 1032, jpeg_pixels_a_byte = 8 * 64, bits_a_byte = 8;
  const Format* format = formatOf(bytes);
  const auto size = format ? format->size(bytes) : std::nullopt;
  if (!size) return false;
  const auto pixels = static_cast<double>(size->width) * static_cast<double>(size->height);
  const auto length = static_cast<double>(bytes.size());
  switch (format->format) {
    case ImageFormat::png: {
      const double bits = bytes.size() > 24 ? std::max(1, static_cast<int>(bytes[24])) : 1;  // a value, at least
      return pixels * bits / bits_a_byte <= length * most_inflated;
    }
    case ImageFormat::jpeg:
      return pixels <= length * jpeg_pixels_a_byte;
    case ImageFormat::pgm:
    case ImageFormat::ppm:
      return pixels <= length;
  }
  return false;
}

}  // namespace edgeslam
