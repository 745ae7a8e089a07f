// What the header of an image file says of its size, before a decoder makes room for it.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace edgeslam {

// [px]; what a header claims, so any values.
struct ClaimedSize {
  std::int64_t width = 0, height = 0;
};

// By how they begin: PNG, JPEG, BMP, PBM to PPM, TIFF or WebP.
bool isImageFormat(std::string_view bytes);

// Of PNG, JPEG, BMP, PBM to PPM, TIFF (its first image; the larger of image and tile) and WebP; none where `bytes` are
// of another format or end before the size. Sources: ISO 15948 11.2.2, ISO 10918-1 B.2.2, TIFF 6.0 section 2, RFC 9649
// section 2, Netpbm's format descriptions.
std::optional<ClaimedSize> claimedSize(std::string_view bytes);

}  // namespace edgeslam
