#include "flow/patch_alignment.h"

#include <cassert>
#include <cmath>

#include "flow/warped_window.h"
#include "image/pyramid.h"

namespace edgeslam {
namespace {

// True where a window of +-radius around the pixel, and the pixel right and below, can be read.
bool readable(const cv::Mat& image, const Eigen::Vector2f& pixel, float radius) {
  const float margin = static_cast<float>(pyramid_border) - 2.0f - radius;
  return pixel.x() >= -margin && pixel.y() >= -margin && pixel.x() < static_cast<float>(image.cols - 1) + margin &&
         pixel.y() < static_cast<float>(image.rows - 1) + margin;  // false for NaN
}

constexpr float grey_unit = 1.0f / samples_per_grey;            // of a sample [grey]
constexpr float gradient_unit = 1.0f / (2 * samples_per_grey);  // of a sample of the gradient [grey/px]

// Where a window around a pixel begins, and how the pixels there are blended.
struct WindowPlace {
  const std::uint8_t* corner;
  std::ptrdiff_t step;
  BilinearWeights weights;
};

WindowPlace placeAround(const cv::Mat& image, const Eigen::Vector2f& centre, int side) {
  const float left = centre.x() - static_cast<float>(side / 2), top = centre.y() - static_cast<float>(side / 2);
  const float left_floor = std::floor(left), top_floor = std::floor(top);
  const auto step = static_cast<std::ptrdiff_t>(image.step[0]);
  return {image.data + static_cast<std::ptrdiff_t>(top_floor) * step + static_cast<std::ptrdiff_t>(left_floor), step,
          bilinearWeights(left - left_floor, top - top_floor)};
}

// The grid that `warp` spreads out around `centre`.
WarpedGrid gridAround(const Eigen::Vector2f& centre, const Eigen::Matrix2f& warp) {
  constexpr int one = 1 << 16;
  const auto fixed = [](float value) { return static_cast<std::int32_t>(std::lround(value * one)); };
  return {fixed(centre.x()), fixed(centre.y()), fixed(warp(0, 0)),
          fixed(warp(1, 0)), fixed(warp(0, 1)), fixed(warp(1, 1))};
}

// Sums in units of grey values and pixels, of values whose mean is taken off exactly.
void writeTemplate(const PatchSums& sums, PatchTemplate& patch) {
  const PatchSamples& samples = patch.samples;
  const auto n = static_cast<double>(samples.side * samples.side);
  const double grey = sums.grey, x = sums.x, y = sums.y;
  patch.grey_left = static_cast<float>(grey / n);
  patch.x_left = static_cast<float>(x / n);
  patch.y_left = static_cast<float>(y / n);
  const double gradient_square = static_cast<double>(gradient_unit) * gradient_unit,
               mixed = static_cast<double>(gradient_unit) * grey_unit,
               grey_square = static_cast<double>(grey_unit) * grey_unit;
  Eigen::Matrix3f& h = patch.normal_matrix;
  h(0, 0) = static_cast<float>((sums.xx - x * x / n) * gradient_square);
  h(1, 1) = static_cast<float>((sums.yy - y * y / n) * gradient_square);
  h(2, 2) = static_cast<float>((sums.grey_grey - grey * grey / n) * grey_square);
  h(0, 1) = h(1, 0) = static_cast<float>((sums.xy - x * y / n) * gradient_square);
  h(0, 2) = h(2, 0) = static_cast<float>((sums.grey_x - x * grey / n) * mixed);
  h(1, 2) = h(2, 1) = static_cast<float>((sums.grey_y - y * grey / n) * mixed);
  const double x_mean = x / n + samples.x_mean, y_mean = y / n + samples.y_mean;
  const auto mean_x = static_cast<float>(x_mean * gradient_unit), mean_y = static_cast<float>(y_mean * gradient_unit);
  patch.tensor = h.topLeftCorner<2, 2>() / static_cast<float>(n);
  patch.tensor(0, 0) += mean_x * mean_x;
  patch.tensor(0, 1) += mean_x * mean_y;
  patch.tensor(1, 0) += mean_x * mean_y;
  patch.tensor(1, 1) += mean_y * mean_y;
}

// A window compared with the patch, each less its mean, in units of grey values and pixels.
struct PatchComparison {
  float square = 0;                           // of the window
  float product = 0, with_x = 0, with_y = 0;  // of the window with the patch, and with its gradient
};

// Of a window's samples less their mean [grey^2].
float windowSquare(std::int32_t samples, std::int32_t squares, double count) {
  return static_cast<float>(squares - static_cast<double>(samples) * samples / count) * (grey_unit * grey_unit);
}

// Of a window's samples with the patch, whose mean is taken off exactly [grey^2].
float windowProduct(const PatchTemplate& patch, std::int32_t samples, std::int32_t with_grey) {
  return (static_cast<float>(with_grey) - patch.grey_left * static_cast<float>(samples)) * (grey_unit * grey_unit);
}

PatchComparison compare(const PatchTemplate& patch, const cv::Mat& image, const Eigen::Vector2f& pixel) {
  const WindowPlace place = placeAround(image, pixel, patch.samples.side);
  const ComparisonSums sums = comparePatch(patch.samples, place.corner, place.step, place.weights);
  const double count = patch.samples.side * patch.samples.side;
  const auto sum = static_cast<float>(sums.samples);
  PatchComparison comparison;
  comparison.square = windowSquare(sums.samples, sums.squares, count);
  comparison.product = windowProduct(patch, sums.samples, sums.with_grey);
  comparison.with_x = (static_cast<float>(sums.with_x) - patch.x_left * sum) * (gradient_unit * grey_unit);
  comparison.with_y = (static_cast<float>(sums.with_y) - patch.y_left * sum) * (gradient_unit * grey_unit);
  return comparison;
}

float correlation(const PatchTemplate& patch, float square, float product) {
  const auto count = static_cast<float>(patch.samples.side * patch.samples.side);
  // Of two variances of a tenth grey value squared: on flat patches the correlation would be rounding errors over
  // nothing.
  const float least_square = 0.01f * count * count;
  return product / std::sqrt(std::max(least_square, square * patch.normal_matrix(2, 2)));
}

// Sums of three floats are written out: in what order Eigen adds them up depends on the processor.
float dot(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  return a.x() * b.x() + (a.y() * b.y() + a.z() * b.z());
}

// The first two rows, of which the steps are made, of the inverse of a symmetric matrix.
struct InverseRows {
  Eigen::Vector3f x, y;
};

InverseRows invert(const Eigen::Matrix3f& h) {
  const auto cofactor = [&h](int row, int column) {
    const int a = (row + 1) % 3, b = (row + 2) % 3, c = (column + 1) % 3, d = (column + 2) % 3;
    return h(a, c) * h(b, d) - h(a, d) * h(b, c);
  };
  const Eigen::Vector3f of_x(cofactor(0, 0), cofactor(1, 0), cofactor(2, 0));
  const Eigen::Vector3f of_y(cofactor(0, 1), cofactor(1, 1), cofactor(2, 1));
  const float scale = 1 / dot(of_x, h.col(0));
  return {of_x * scale, of_y * scale};
}

}  // namespace

bool makeTemplate(const cv::Mat& image, const Eigen::Vector2f& pixel, const Eigen::Matrix2f& warp, int side,
                  PatchTemplate& patch) {
  assert(image.type() == CV_8U && side >= 1 && side <= largest_patch_side);
  const int outer = side + 2;  // one more on each side for the central differences
  const auto radius = static_cast<float>(outer / 2);
  const float reach = radius * std::max(warp.row(0).cwiseAbs().sum(), warp.row(1).cwiseAbs().sum());
  if (!readable(image, pixel, reach)) return false;
  SampledWindow window;
  if (warp == Eigen::Matrix2f::Identity()) {
    const WindowPlace place = placeAround(image, pixel, outer);
    sampleWindow(place.corner, place.step, place.weights, side, window);
  } else {
    sampleWarpedWindow(image.data, static_cast<std::ptrdiff_t>(image.step[0]), gridAround(pixel, warp), side, window);
  }
  writeTemplate(makePatchSamples(window, side, patch.samples), patch);
  return true;
}

AlignmentResult alignPatch(const PatchTemplate& patch, const cv::Mat& image, const Eigen::Vector2f& start,
                           const Eigen::Vector2f& prediction, const AlignmentOptions& options) {
  const auto count = static_cast<float>(patch.samples.side * patch.samples.side);
  const float damping = options.damping * count;
  Eigen::Matrix3f h = patch.normal_matrix;
  h(0, 0) += damping;
  h(1, 1) += damping;
  h(2, 2) += count;  // keeps the gain defined on a flat patch
  const InverseRows inverse = invert(h);

  AlignmentResult result;
  result.pixel = start;
  const auto radius = static_cast<float>(patch.samples.side / 2);
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    if (!readable(image, result.pixel, radius)) return result;
    // Normal equations of T(x + delta) (1 + gain) + bias = I(x + pixel); the template's terms have no mean, so the bias
    // drops out.
    const PatchComparison comparison = compare(patch, image, result.pixel);
    result.correlation = correlation(patch, comparison.square, comparison.product);
    const Eigen::Vector2f pull = damping * (result.pixel - prediction);
    const Eigen::Vector3f right(comparison.with_x - patch.normal_matrix(0, 2) + pull.x(),
                                comparison.with_y - patch.normal_matrix(1, 2) + pull.y(),
                                comparison.product - patch.normal_matrix(2, 2));
    const Eigen::Vector2f step(dot(inverse.x, right), dot(inverse.y, right));
    result.pixel -= step;
    if (step.squaredNorm() < options.convergence * options.convergence) {
      result.converged = true;
      break;
    }
  }
  result.inside = readable(image, result.pixel, radius);
  return result;
}

float correlationAt(const PatchTemplate& patch, const cv::Mat& image, const Eigen::Vector2f& pixel) {
  if (!readable(image, pixel, static_cast<float>(patch.samples.side / 2))) return -1;
  const WindowPlace place = placeAround(image, pixel, patch.samples.side);
  const CorrelationSums sums = correlatePatch(patch.samples, place.corner, place.step, place.weights);
  return correlation(patch, windowSquare(sums.samples, sums.squares, patch.samples.side * patch.samples.side),
                     windowProduct(patch, sums.samples, sums.with_grey));
}

PatchDifference differenceAt(const PatchTemplate& patch, const cv::Mat& image, const Eigen::Vector2f& pixel) {
  assert(readable(image, pixel, static_cast<float>(patch.samples.side / 2)));
  const PatchComparison comparison = compare(patch, image, pixel);
  const Eigen::Matrix3f& h = patch.normal_matrix;
  PatchDifference difference;
  difference.squares = std::max(0.0f, comparison.square - 2 * comparison.product + h(2, 2));
  difference.along_gradient = {comparison.with_x - h(0, 2), comparison.with_y - h(1, 2)};
  return difference;
}

}  // namespace edgeslam
