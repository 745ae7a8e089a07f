#include "flow/patch_alignment.h"

#include <Eigen/LU>
#include <cmath>

#include "image/pyramid.h"

namespace edgeslam {
namespace {

// True where a window of +-radius around the pixel, and the pixel right and below, can be read.
bool readable(const cv::Mat& image, const Eigen::Vector2f& pixel, float radius) {
  const float margin = static_cast<float>(pyramid_border) - 2.0f - radius;
  return pixel.x() >= -margin && pixel.y() >= -margin && pixel.x() < static_cast<float>(image.cols - 1) + margin &&
         pixel.y() < static_cast<float>(image.rows - 1) + margin;  // false for NaN
}

float sampleBilinear(const cv::Mat& image, float x, float y) {
  const float x_floor = std::floor(x), y_floor = std::floor(y);
  const float a = x - x_floor, b = y - y_floor;
  const auto step = static_cast<std::ptrdiff_t>(image.step[0]);
  const unsigned char* p =
      image.data + static_cast<std::ptrdiff_t>(y_floor) * step + static_cast<std::ptrdiff_t>(x_floor);
  return (1 - b) * ((1 - a) * static_cast<float>(p[0]) + a * static_cast<float>(p[1])) +
         b * ((1 - a) * static_cast<float>(p[step]) + a * static_cast<float>(p[step + 1]));
}

// side x side samples around `centre`, unit spacing: one set of bilinear weights for all.
void sampleWindow(const cv::Mat& image, const Eigen::Vector2f& centre, int side, float* samples) {
  const float left = centre.x() - static_cast<float>(side / 2), top = centre.y() - static_cast<float>(side / 2);
  const float left_floor = std::floor(left), top_floor = std::floor(top);
  const float a = left - left_floor, b = top - top_floor;
  const float w00 = (1 - a) * (1 - b), w01 = a * (1 - b), w10 = (1 - a) * b, w11 = a * b;
  const auto step = static_cast<std::ptrdiff_t>(image.step[0]);
  const unsigned char* row =
      image.data + static_cast<std::ptrdiff_t>(top_floor) * step + static_cast<std::ptrdiff_t>(left_floor);
  for (int y = 0; y < side; ++y, row += step, samples += side) {
    const unsigned char* below = row + step;
    for (int x = 0; x < side; ++x) {
      samples[x] = w00 * static_cast<float>(row[x]) + w01 * static_cast<float>(row[x + 1]) +
                   w10 * static_cast<float>(below[x]) + w11 * static_cast<float>(below[x + 1]);
    }
  }
}

void sampleWarped(const cv::Mat& image, const Eigen::Vector2f& centre, const Eigen::Matrix2f& warp, int side,
                  float* samples) {
  const int radius = side / 2;
  for (int y = -radius; y <= radius; ++y) {
    for (int x = -radius; x <= radius; ++x) {
      const Eigen::Vector2f at = centre + warp * Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y));
      *samples++ = sampleBilinear(image, at.x(), at.y());
    }
  }
}

}  // namespace

bool makeTemplate(const cv::Mat& image, const Eigen::Vector2f& pixel, const Eigen::Matrix2f& warp, int side,
                  PatchTemplate& patch) {
  const int outer = side + 2;  // one more on each side for the central differences
  const auto radius = static_cast<float>(outer / 2);
  const float reach = radius * std::max(warp.row(0).cwiseAbs().sum(), warp.row(1).cwiseAbs().sum());
  if (!readable(image, pixel, reach)) return false;
  std::array<float, (largest_patch_side + 2) * (largest_patch_side + 2)> samples;
  if (warp == Eigen::Matrix2f::Identity()) {
    sampleWindow(image, pixel, outer, samples.data());
  } else {
    sampleWarped(image, pixel, warp, outer, samples.data());
  }
  const int count = side * side;
  patch.side = side;
  patch.grey.resize(count);
  patch.gradient_x.resize(count);
  patch.gradient_y.resize(count);
  for (int y = 0; y < side; ++y) {
    const float* row = samples.data() + (y + 1) * outer + 1;
    for (int x = 0; x < side; ++x) {
      patch.grey[y * side + x] = row[x];
      patch.gradient_x[y * side + x] = 0.5f * (row[x + 1] - row[x - 1]);
      patch.gradient_y[y * side + x] = 0.5f * (row[x + outer] - row[x - outer]);
    }
  }
  const auto n = static_cast<float>(count);
  const float xx = patch.gradient_x.squaredNorm(), xy = patch.gradient_x.dot(patch.gradient_y),
              yy = patch.gradient_y.squaredNorm();
  patch.tensor << xx / n, xy / n, xy / n, yy / n;
  patch.grey.array() -= patch.grey.mean();
  patch.gradient_x.array() -= patch.gradient_x.mean();
  patch.gradient_y.array() -= patch.gradient_y.mean();
  Eigen::Matrix3f& h = patch.normal_matrix;
  h(0, 0) = patch.gradient_x.squaredNorm();
  h(1, 1) = patch.gradient_y.squaredNorm();
  h(2, 2) = patch.grey.squaredNorm();
  h(0, 1) = h(1, 0) = patch.gradient_x.dot(patch.gradient_y);
  h(0, 2) = h(2, 0) = patch.gradient_x.dot(patch.grey);
  h(1, 2) = h(2, 1) = patch.gradient_y.dot(patch.grey);
  return true;
}

AlignmentResult alignPatch(const PatchTemplate& patch, const cv::Mat& image, const Eigen::Vector2f& start,
                           const Eigen::Vector2f& prediction, const AlignmentOptions& options) {
  const auto count = static_cast<float>(patch.side * patch.side);
  const float damping = options.damping * count;
  Eigen::Matrix3f h = patch.normal_matrix;
  h(0, 0) += damping;
  h(1, 1) += damping;
  h(2, 2) += count;  // keeps the gain defined on a flat patch
  const Eigen::Matrix3f inverse = h.inverse();

  AlignmentResult result;
  result.pixel = start;
  PatchTemplate::Samples samples(patch.grey.size());
  // Of two variances of a tenth grey value squared: on flat patches the correlation would be rounding errors over
  // nothing.
  const float least_square = 0.01f * count * count;
  const auto radius = static_cast<float>(patch.side / 2);
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    if (!readable(image, result.pixel, radius)) return result;
    sampleWindow(image, result.pixel, patch.side, samples.data());
    const float sum = samples.sum(), square = samples.squaredNorm(), product = patch.grey.dot(samples);
    const float variance = square - sum * sum / count;
    result.correlation = product / std::sqrt(std::max(least_square, variance * patch.normal_matrix(2, 2)));
    // Normal equations of T(x + delta) (1 + gain) + bias = I(x + pixel); the template's terms have no mean, so the bias
    // drops out.
    const Eigen::Vector2f pull = damping * (result.pixel - prediction);
    const Eigen::Vector3f right(patch.gradient_x.dot(samples) - patch.normal_matrix(0, 2) + pull.x(),
                                patch.gradient_y.dot(samples) - patch.normal_matrix(1, 2) + pull.y(),
                                product - patch.normal_matrix(2, 2));
    const Eigen::Vector2f step = (inverse * right).head<2>();
    result.pixel -= step;
    if (step.squaredNorm() < options.convergence * options.convergence) {
      result.converged = true;
      break;
    }
  }
  result.inside = readable(image, result.pixel, radius);
  return result;
}

}  // namespace edgeslam
