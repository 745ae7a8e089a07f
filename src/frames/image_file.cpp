#include "frames/image_file.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <string_view>
#include <vector>

#include "frames/image_header.h"

namespace edgeslam {
namespace {

using Bytes = std::vector<unsigned char>;

bool isJpeg(const Bytes& bytes) { return bytes.size() > 2 && bytes[0] == 0xFF && bytes[1] == 0xD8; }

// Walks the segments of a JPEG file to its end-of-image marker (ISO 10918-1, annex B). An embedded thumbnail has such a
// marker too, so the last bytes alone don't tell.
bool jpegIsWhole(const Bytes& bytes) {
  std::size_t at = 2;
  while (at + 1 < bytes.size()) {
    if (bytes[at] != 0xFF) {  // entropy-coded data
      ++at;
      continue;
    }
    const unsigned char marker = bytes[at + 1];
    if (marker == 0xD9) return true;
    if (marker == 0xFF) {
      ++at;
      continue;
    }
    at += 2;
    const bool stands_alone = marker == 0x00 || marker == 0x01 || (marker >= 0xD0 && marker <= 0xD8);
    if (stands_alone) continue;
    if (at + 1 >= bytes.size()) return false;
    at += static_cast<std::size_t>(bytes[at]) * 256 + bytes[at + 1];
  }
  return false;
}

// A decoder would make room for what a few bytes claim.
bool isTooLarge(const ClaimedSize& size) {
  constexpr std::int64_t most_pixels = std::int64_t{1} << 26;
  return std::max(size.width, size.height) > most_pixels || size.width * size.height > most_pixels;
}

std::string sizeText(cv::Size size) { return std::to_string(size.width) + " x " + std::to_string(size.height); }

}  // namespace

DecodedImage readGreyImage(const std::string& path) {
  constexpr std::uintmax_t largest_file = std::uintmax_t{1} << 29;
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) return {{}, path + ": no such file"};
  if (!std::filesystem::is_regular_file(status)) return {{}, path + ": is not a file"};
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error || size > largest_file) return {{}, path + ": too large for an image"};
  std::ifstream file(path, std::ios::binary);
  const Bytes bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  if (!file || bytes.size() != size) return {{}, path + ": cannot be read"};
  if (bytes.empty()) return {{}, path + ": is empty"};
  const std::string_view content(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  // OpenCV alone would hand some bytes to GDAL, through a file in /tmp; among GDAL's formats are some that name other
  // files and hosts to read.
  if (!isImageFormat(content)) return {{}, path + ": is no PNG, JPEG, BMP, PGM, PPM, TIFF or WebP image"};
  const auto size_claimed = claimedSize(content);
  if (size_claimed && isTooLarge(*size_claimed)) return {{}, path + ": too large for an image"};
  if (isJpeg(bytes) && !jpegIsWhole(bytes)) return {{}, path + ": is cut off"};
  if (!size_claimed) return {{}, path + ": is no image that can be decoded, or is damaged"};

  cv::Mat decoded;
  try {
    decoded = cv::imdecode(bytes, cv::IMREAD_GRAYSCALE | cv::IMREAD_ANYDEPTH | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception&) {
    decoded.release();
  }
  if (decoded.empty()) return {{}, path + ": is no image that can be decoded, or is damaged"};
  if (decoded.depth() == CV_16U) decoded.convertTo(decoded, CV_8U, 1.0 / 257.0);
  if (decoded.type() != CV_8UC1) return {{}, path + ": expected 8 or 16 bits a channel"};
  return {decoded, ""};
}

std::string sizeProblem(cv::Size size, cv::Size expected, const std::string& expected_by) {
  if (expected.empty() || size == expected) return "";
  return "is " + sizeText(size) + " pixels, " + expected_by + " " + sizeText(expected);
}

}  // namespace edgeslam
