#include "frames/image_header.h"

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

// Rows from the top down have a negative height.
std::optional<ClaimedSize> sizeInBmp(std::string_view bytes) {
  const Numbers numbers(bytes, true);
  const bool is_first_version = numbers.at(14, 4) == 12;
  if (is_first_version) return numbers.sizeAt(18, 20, 2);
  std::optional<ClaimedSize> size = numbers.sizeAt(18, 22, 4);
  if (size) size->height = std::min(size->height, (std::int64_t{1} << 32) - size->height);
  return size;
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

std::optional<ClaimedSize> sizeInTiff(std::string_view bytes) {
  constexpr std::int64_t width_tag = 256, height_tag = 257, tile_width_tag = 322, tile_height_tag = 323, short_type = 3;
  constexpr std::size_t entry_size = 12;
  const Numbers numbers(bytes, bytes[0] == 'I');
  const auto directory = numbers.at(4, 4);
  const auto entries = directory ? numbers.at(static_cast<std::size_t>(*directory), 2) : std::nullopt;
  if (!entries) return std::nullopt;
  ClaimedSize size;
  for (std::int64_t i = 0; i < *entries; ++i) {
    const std::size_t entry = static_cast<std::size_t>(*directory) + 2 + static_cast<std::size_t>(i) * entry_size;
    const auto tag = numbers.at(entry, 2), type = numbers.at(entry + 2, 2);
    const auto value = numbers.at(entry + 8, type == short_type ? 2 : 4);
    if (!value) return std::nullopt;
    if (tag == width_tag || tag == tile_width_tag) size.width = std::max(size.width, *value);
    if (tag == height_tag || tag == tile_height_tag) size.height = std::max(size.height, *value);
  }
  if (size.width == 0 || size.height == 0) return std::nullopt;
  return size;
}

// Of its three kinds of first chunks: lossy, lossless, extended.
std::optional<ClaimedSize> sizeInWebp(std::string_view bytes) {
  const Numbers numbers(bytes, true);
  const std::string_view chunk = bytes.substr(12, 4);
  if (chunk == "VP8X") {
    const auto size = numbers.sizeAt(24, 27, 3);
    return size ? std::optional<ClaimedSize>({size->width + 1, size->height + 1}) : std::nullopt;
  }
  constexpr std::int64_t fourteen_bits = (1 << 14) - 1;
  if (chunk == "VP8L") {
    const auto bits = numbers.at(21, 4);
    if (!bits) return std::nullopt;
    return ClaimedSize{(*bits & fourteen_bits) + 1, (*bits >> 14 & fourteen_bits) + 1};
  }
  const auto size = chunk == "VP8 " ? numbers.sizeAt(26, 28, 2) : std::nullopt;
  if (!size) return std::nullopt;
  return ClaimedSize{size->width & fourteen_bits, size->height & fourteen_bits};
}

struct Format {
  std::string_view beginning;  // '?' stands for any byte
  std::optional<ClaimedSize> (*size)(std::string_view bytes);

  bool isOf(std::string_view bytes) const {
    return bytes.size() >= beginning.size() &&
           std::equal(beginning.begin(), beginning.end(), bytes.begin(),
                      [](char expected, char found) { return expected == '?' || expected == found; });
  }
};

constexpr std::array<Format, 12> formats{{{"\x89PNG\r\n\x1a\n"sv, sizeInPng},
                                          {"\xFF\xD8\xFF"sv, sizeInJpeg},
                                          {"BM"sv, sizeInBmp},
                                          {"P1"sv, sizeInNetpbm},
                                          {"P2"sv, sizeInNetpbm},
                                          {"P3"sv, sizeInNetpbm},
                                          {"P4"sv, sizeInNetpbm},
                                          {"P5"sv, sizeInNetpbm},
                                          {"P6"sv, sizeInNetpbm},
                                          {"II*\0"sv, sizeInTiff},
                                          {"MM\0*"sv, sizeInTiff},
                                          {"RIFF????WEBP"sv, sizeInWebp}}};

const Format* formatOf(std::string_view bytes) {
  const auto* format = std::find_if(formats.begin(), formats.end(), [&](const Format& f) { return f.isOf(bytes); });
  return format == formats.end() ? nullptr : format;
}

}  // namespace

bool isImageFormat(std::string_view bytes) { return formatOf(bytes) != nullptr; }

std::optional<ClaimedSize> claimedSize(std::string_view bytes) {
  const Format* format = formatOf(bytes);
  return format ? format->size(bytes) : std::nullopt;
}

}  // namespace edgeslam
