#include "image/gradient_products.h"

#include <cassert>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "image/gradient_products.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace edgeslam {
namespace HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR

GradientProducts sumVectors(const cv::Mat& grey, const cv::Rect& window) {
  return gradientProductsReference(grey, window);
}

#else

namespace hn = hwy::HWY_NAMESPACE;

using Narrow = hn::CappedTag<int16_t, 16>;  // windows are about as wide
using Wide = hn::RepartitionToWide<Narrow>;
using Vector = hn::Vec<Narrow>;

Vector pixelsAt(const uint8_t* at) { return hn::PromoteTo(Narrow(), hn::LoadU(hn::Rebind<uint8_t, Narrow>(), at)); }

struct Sum {
  hn::Vec<Wide> first;
  hn::Vec<Wide> second;

  Sum() : first(hn::Zero(Wide())), second(hn::Zero(Wide())) {}
  void add(Vector a, Vector b) { first = hn::ReorderWidenMulAccumulate(Wide(), a, b, first, second); }
  int64_t total() const { return hn::GetLane(hn::SumOfLanes(Wide(), hn::Add(first, second))); }
};

// True where every vector of a row and its neighbours to all sides lie in the image, and no sum grows too large.
bool fitsVectors(const cv::Size& size, const cv::Rect& window, int lanes) {
  constexpr int most_pixels = 1 << 15;  // (2^15)(255^2) < 2^31
  const int width = (window.width + lanes - 1) / lanes * lanes;
  return window.x > 0 && window.y > 0 && window.x + width < size.width && window.y + window.height < size.height &&
         window.area() <= most_pixels;
}

GradientProducts sumVectors(const cv::Mat& grey, const cv::Rect& window) {
  const int lanes = static_cast<int>(hn::Lanes(Narrow()));
  if (!fitsVectors(grey.size(), window, lanes)) return gradientProductsReference(grey, window);
  const auto step = static_cast<std::ptrdiff_t>(grey.step[0]);
  Sum xx;
  Sum xy;
  Sum yy;
  for (int x = 0; x < window.width; x += lanes) {
    const auto inside =
        hn::VecFromMask(Narrow(), hn::FirstN(Narrow(), static_cast<size_t>(window.width - x)));  // of the window
    const uint8_t* row = grey.ptr<uint8_t>(window.y) + window.x + x;
    Vector above = pixelsAt(row - step);
    Vector here = pixelsAt(row);
    for (int y = 0; y < window.height; ++y, row += step) {
      const Vector below = pixelsAt(row + step);
      const Vector along_x = hn::And(hn::Sub(pixelsAt(row + 1), pixelsAt(row - 1)), inside);
      const Vector along_y = hn::And(hn::Sub(below, above), inside);
      xx.add(along_x, along_x);
      xy.add(along_x, along_y);
      yy.add(along_y, along_y);
      above = here;
      here = below;
    }
  }
  GradientProducts products;
  products.xx = xx.total();
  products.xy = xy.total();
  products.yy = yy.total();
  products.count = window.area();
  return products;
}

#endif

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace edgeslam
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace edgeslam {

HWY_EXPORT(sumVectors);

GradientProducts gradientProducts(const cv::Mat& grey, const cv::Rect& window) {
  assert(grey.type() == CV_8U && (window & cv::Rect({}, grey.size())) == window);
  return HWY_DYNAMIC_DISPATCH(sumVectors)(grey, window);
}

}  // namespace edgeslam
#endif
