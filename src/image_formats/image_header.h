// What the header of an image file says of its format and size, before a decoder makes room for it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace edgeslam {

enum class ImageFormat {
  png,
  jpeg,
  pgm,  // P5
  ppm,  // P6
};

// By how the file begins; none where it is of no format that is read here.
std::optional<ImageFormat> imageFormat(std::string_view bytes);

// What the file is where it is an image of another format, as "a TIFF image"; otherwise empty.
std::string otherImageFormat(std::string_view bytes);

constexpr std::int64_t most_pixels = std::int64_t{1} << 26;  // of an image that is read

// [px]; what a header claims, so any values.
struct ClaimedSize {
  std::int64_t width = 0, height = 0;
};

// None where `bytes` are of no format that is read here, or end before the size. Sources: ISO 15948 11.2.2, ISO 10918-1
// B.2.2, Netpbm's format descriptions.
std::optional<ClaimedSize> claimedSize(std::string_view bytes);

// Whether an image of the claimed size can be in so few bytes as there are: of a PNG, deflate makes at most 1032 bytes
// of one; of a JPEG, each block of 8 x 8 pixels takes at least a bit; a PGM or PPM has a byte for each value. What
// cannot be whole is not worth the memory and the time that its header claims.
bool canHoldItsSize(std::string_view bytes);

}  // namespace edgeslam
