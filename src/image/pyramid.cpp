#include "image/pyramid.h"

#include <array>
#include <cstdint>
#include <cstring>

#include "image/halving.h"

namespace edgeslam {
namespace {

static_assert(pyramid_border >= halving_border);

// The pixel that lies at `at`, possibly outside of 0 .. count - 1, when the image is mirrored at its outermost pixels.
int mirrored(int at, int count) {
  if (count == 1) return 0;
  const int period = 2 * (count - 1);
  const int inside = ((at % period) + period) % period;
  return inside < count ? inside : period - inside;
}

// Makes `level` a view of this size with pyramid_border pixels around; keeps the memory of one that is.
void shapeLevel(const cv::Size& size, cv::Mat& level) {
  const cv::Size whole(size.width + 2 * pyramid_border, size.height + 2 * pyramid_border);
  const cv::Rect inner(cv::Point(pyramid_border, pyramid_border), size);
  if (level.type() == CV_8U && level.size() == size && level.isSubmatrix()) {
    cv::Size held;
    cv::Point offset;
    level.locateROI(held, offset);
    if (held == whole && offset == inner.tl()) return;
  }
  level = cv::Mat(whole, CV_8U)(inner);
}

void mirrorIntoBorder(cv::Mat& level) {
  const int width = level.cols;
  const auto step = static_cast<std::ptrdiff_t>(level.step[0]);
  std::array<int, pyramid_border> left;  // what the pixel k + 1 to the left of the image mirrors
  std::array<int, pyramid_border> right;
  for (int k = 0; k < pyramid_border; ++k) {
    left[static_cast<size_t>(k)] = mirrored(-k - 1, width);
    right[static_cast<size_t>(k)] = mirrored(width + k, width);
  }
  for (int y = 0; y < level.rows; ++y) {
    uint8_t* row = level.ptr<uint8_t>(y);
    for (int k = 0; k < pyramid_border; ++k) {
      row[-k - 1] = row[left[static_cast<size_t>(k)]];
      row[width + k] = row[right[static_cast<size_t>(k)]];
    }
  }
  const auto copyRow = [&](int to) {
    std::memcpy(level.data + step * to - pyramid_border, level.data + step * mirrored(to, level.rows) - pyramid_border,
                static_cast<size_t>(width + 2 * pyramid_border));
  };
  for (int k = 1; k <= pyramid_border; ++k) {
    copyRow(-k);
    copyRow(level.rows - 1 + k);
  }
}

}  // namespace

void buildPyramid(const cv::Mat& grey, int level_count, ImagePyramid& pyramid) {
  CV_Assert(grey.type() == CV_8U && !grey.empty());
  cv::Size size = grey.size();
  for (size_t level = 0;; ++level) {
    if (pyramid.levels.size() == level) pyramid.levels.emplace_back();
    cv::Mat& image = pyramid.levels[level];
    shapeLevel(size, image);
    if (level == 0) {
      for (int y = 0; y < grey.rows; ++y) {
        std::memcpy(image.ptr(y), grey.ptr(y), static_cast<size_t>(grey.cols));
      }
    } else {
      halve(pyramid.levels[level - 1], image);
    }
    mirrorIntoBorder(image);
    const bool last = static_cast<int>(level) + 1 >= level_count || size.width < 32 || size.height < 32;
    if (last) {
      pyramid.levels.resize(level + 1);
      return;
    }
    size = halfOf(size);
  }
}

ImagePyramid buildPyramid(const cv::Mat& grey, int level_count) {
  ImagePyramid pyramid;
  buildPyramid(grey, level_count, pyramid);
  return pyramid;
}

}  // namespace edgeslam
