#include "frames/image_file.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>

#include "image_formats/image_header.h"
#include "image_formats/jpeg.h"
#include "image_formats/netpbm.h"
#include "image_formats/png.h"

namespace edgeslam {
namespace {

// A decoder would make room for what a few bytes claim.
bool isTooLarge(const ClaimedSize& size) {
  constexpr std::int64_t most_pixels = std::int64_t{1} << 26;
  return std::max(size.width, size.height) > most_pixels || size.width * size.height > most_pixels;
}

std::string sizeText(cv::Size size) { return std::to_string(size.width) + " x " + std::to_string(size.height); }

// Why the bytes are not worth decoding, by their header and length; otherwise empty.
std::string problemOfHeader(std::string_view bytes, const ExpectedSize& expected) {
  const auto format = imageFormat(bytes);
  if (!format) {
    const std::string other = otherImageFormat(bytes);
    return other.empty() ? "is no PNG, JPEG, PGM (P5) or PPM (P6) image" : "is " + other + "; convert it to PNG";
  }
  const auto claimed = claimedSize(bytes);
  if (claimed && isTooLarge(*claimed)) return "too large for an image";
  if (format == ImageFormat::jpeg && !jpegIsWhole(bytes)) return "is cut off";
  if (!claimed) return "is no image that can be decoded, or is damaged";
  const cv::Size size(static_cast<int>(claimed->width), static_cast<int>(claimed->height));
  std::string wrong = sizeProblem(size, expected.size, expected.by);
  if (!wrong.empty()) return wrong;
  if (!canHoldItsSize(bytes)) {
    return "is cut off or damaged: " + sizeText(size) + " pixels are not in " + std::to_string(bytes.size()) + " bytes";
  }
  return "";
}

cv::Mat decode(std::string_view bytes) {
  switch (*imageFormat(bytes)) {
    case ImageFormat::png:
      return decodePng(bytes);
    case ImageFormat::jpeg:
      return decodeJpeg(bytes);
    case ImageFormat::pgm:
    case ImageFormat::ppm:
      break;
  }
  return decodeNetpbm(bytes);
}

}  // namespace

DecodedImage readGreyImage(const std::string& path, const ExpectedSize& expected) {
  constexpr std::uintmax_t largest_file = std::uintmax_t{1} << 29;
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) return {{}, path + ": no such file"};
  if (!std::filesystem::is_regular_file(status)) return {{}, path + ": is not a file"};
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error || size > largest_file) return {{}, path + ": too large for an image"};
  std::ifstream file(path, std::ios::binary);
  std::string bytes(size, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(size));
  const bool is_whole = file && file.peek() == std::ifstream::traits_type::eof();
  if (!is_whole) return {{}, path + ": cannot be read"};
  DecodedImage image = decodeGreyImage(bytes, expected);
  if (!image.problem.empty()) image.problem.insert(0, path + ": ");
  return image;
}

DecodedImage decodeGreyImage(std::string_view bytes, const ExpectedSize& expected) {
  if (bytes.empty()) return {{}, "is empty"};
  const std::string problem = problemOfHeader(bytes, expected);
  if (!problem.empty()) return {{}, problem};
  cv::Mat grey = decode(bytes);
  if (grey.empty()) return {{}, "is no image that can be decoded, or is damaged"};
  if (grey.depth() == CV_16U) grey.convertTo(grey, CV_8U, 1.0 / 257.0);
  return {grey, ""};
}

std::string sizeProblem(cv::Size size, cv::Size expected, const std::string& expected_by) {
  if (expected.empty() || size == expected) return "";
  return "is " + sizeText(size) + " pixels, " + expected_by + " " + sizeText(expected);
}

}  // namespace edgeslam
