#include "map/packed_image.h"

#include <zstd.h>

#include <algorithm>
#include <cstddef>
#include <new>
#include <stdexcept>

namespace edgeslam {
namespace {

constexpr int compression_level = 1;  // the fastest that is meant for general use

// What a pixel is expected to be: the plane through its neighbours, held between them.
unsigned char predicted(int left, int above, int above_left) {
  const auto [least, most] = std::minmax(left, above);
  return static_cast<unsigned char>(std::clamp(left + above - above_left, least, most));
}

// Calls `visit(index of the pixel, prediction)` for every pixel in order; `pixels` has those before.
template <typename Visit>
void predictAll(const cv::Size& size, const unsigned char* pixels, const Visit& visit) {
  const auto width = static_cast<std::size_t>(size.width), height = static_cast<std::size_t>(size.height);
  visit(0, 0);
  for (std::size_t x = 1; x < width; ++x) visit(x, pixels[x - 1]);
  for (std::size_t y = 1; y < height; ++y) {
    const std::size_t begin = y * width, above = begin - width;
    visit(begin, pixels[above]);
    for (std::size_t x = 1; x < width; ++x) {
      visit(begin + x, predicted(pixels[begin + x - 1], pixels[above + x], pixels[above + x - 1]));
    }
  }
}

}  // namespace

PackedImage packed(const cv::Mat& grey) {
  CV_Assert(grey.type() == CV_8U && !grey.empty());
  const cv::Mat whole = grey.isContinuous() ? grey : grey.clone();
  const unsigned char* pixels = whole.data;
  std::vector<unsigned char> differences(whole.total());
  predictAll(whole.size(), pixels, [&](std::size_t i, unsigned char prediction) {
    differences[i] = static_cast<unsigned char>(pixels[i] - prediction);
  });
  PackedImage image{whole.size(), std::vector<unsigned char>(ZSTD_compressBound(differences.size()))};
  const std::size_t size =
      ZSTD_compress(image.bytes.data(), image.bytes.size(), differences.data(), differences.size(), compression_level);
  if (ZSTD_isError(size) != 0) throw std::bad_alloc();  // there is room for the result, so nothing else can fail
  image.bytes.resize(size);
  image.bytes.shrink_to_fit();
  return image;
}

cv::Mat unpacked(const PackedImage& image) {
  cv::Mat grey(image.size, CV_8U);
  unsigned char* pixels = grey.data;
  const std::size_t size = ZSTD_decompress(pixels, grey.total(), image.bytes.data(), image.bytes.size());
  if (ZSTD_isError(size) != 0 || size != grey.total()) throw std::logic_error("not a packed image");
  predictAll(image.size, pixels, [&](std::size_t i, unsigned char prediction) {
    pixels[i] = static_cast<unsigned char>(pixels[i] + prediction);
  });
  return grey;
}

}  // namespace edgeslam
