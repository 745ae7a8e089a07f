#include "image_formats/netpbm.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <optional>
#include <string>

#include "image_formats/image_header.h"

namespace edgeslam {
namespace {

constexpr std::int64_t too_many = 1'000'000'000;

struct NetpbmHeader {
  std::int64_t width = 0, height = 0, largest = 0;
  std::size_t size = 0;  // [byte]
};

bool isBlank(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }
bool isDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

// Three decimal numbers after the two letters, parted by blanks and comments; one blank ends them.
std::optional<NetpbmHeader> readHeader(std::string_view bytes) {
  std::array<std::int64_t, 3> numbers{};
  std::size_t at = 2;
  for (std::int64_t& number : numbers) {
    while (at < bytes.size() && (isBlank(bytes[at]) || bytes[at] == '#')) {
      at = bytes[at] == '#' ? std::min(bytes.find('\n', at), bytes.size()) : at + 1;
    }
    if (at == bytes.size() || !isDigit(bytes[at])) return std::nullopt;
    for (; at < bytes.size() && isDigit(bytes[at]); ++at) number = std::min(number * 10 + (bytes[at] - '0'), too_many);
  }
  if (at == bytes.size() || !isBlank(bytes[at])) return std::nullopt;
  return NetpbmHeader{numbers[0], numbers[1], numbers[2], at + 1};
}

// The weights in 14 bits.
std::int64_t greyOf(std::int64_t red, std::int64_t green, std::int64_t blue) {
  return (4899 * red + 9617 * green + 1868 * blue + (1 << 13)) >> 14;
}

}  // namespace

cv::Mat decodeNetpbm(std::string_view bytes) {
  const std::optional<NetpbmHeader> header = readHeader(bytes);
  if (!header || header->width < 1 || header->height < 1 || header->largest < 1 || header->largest > 65535) return {};
  if (header->width > most_pixels || header->height > most_pixels || header->width * header->height > most_pixels) {
    return {};
  }
  const std::size_t channels = bytes[1] == '6' ? 3 : 1, value_size = header->largest > 255 ? 2 : 1;
  const auto pixels = static_cast<std::size_t>(header->width * header->height);
  if (bytes.size() - header->size < pixels * channels * value_size) return {};
  const auto* at = reinterpret_cast<const unsigned char*>(bytes.data()) + header->size;
  const auto next = [&] {
    const std::int64_t value = value_size == 1 ? at[0] : at[0] * 256 + at[1];
    at += value_size;
    return std::min(value, header->largest);
  };
  cv::Mat grey(static_cast<int>(header->height), static_cast<int>(header->width), CV_8U);
  if (channels == 1 && header->largest == 255) {
    std::copy_n(at, pixels, grey.data);
    return grey;
  }
  for (int y = 0; y < grey.rows; ++y) {
    unsigned char* row = grey.ptr(y);
    for (int x = 0; x < grey.cols; ++x) {
      std::int64_t value = next();
      if (channels == 3) {
        const std::int64_t green = next(), blue = next();
        value = greyOf(value, green, blue);
      }
      row[x] = static_cast<unsigned char>((value * 255 + header->largest / 2) / header->largest);
    }
  }
  return grey;
}

std::vector<unsigned char> encodePgm(const cv::Mat& grey) {
  CV_Assert(grey.type() == CV_8U);
  const std::string header = "P5\n" + std::to_string(grey.cols) + " " + std::to_string(grey.rows) + "\n255\n";
  std::vector<unsigned char> bytes;
  bytes.reserve(header.size() + grey.total());
  bytes.assign(header.begin(), header.end());
  for (int y = 0; y < grey.rows; ++y) bytes.insert(bytes.end(), grey.ptr(y), grey.ptr(y) + grey.cols);
  return bytes;
}

}  // namespace edgeslam
