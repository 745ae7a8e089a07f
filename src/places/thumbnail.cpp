#include "places/thumbnail.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "geometry/angles.h"
#include "image/hidden_part.h"

namespace edgeslam {
namespace {

constexpr double blur_sigma = 1.2;      // [px of the thumbnail]
constexpr double lighting_sigma = 10;   // slower changes of the grey values are lighting and vignetting [px]
constexpr double largest_shift = 0.25;  // share of the width and of the height
constexpr double roll_step = radians(6);
constexpr int roll_steps = 4;  // to each side

// Correlation of first(x + dx, y + dy) with second(x, y) over the pixels that both have.
double correlationAt(const Thumbnail& first, const Thumbnail& second, int dx, int dy) {
  const int left = std::max(0, -dx), right = std::min(second.cols, first.cols - dx);
  const int top = std::max(0, -dy), bottom = std::min(second.rows, first.rows - dy);
  float aa = 0, bb = 0, ab = 0, a = 0, b = 0;
  for (int y = top; y < bottom; ++y) {
    const float* p = first.ptr<float>(y + dy) + dx;
    const float* q = second.ptr<float>(y);
    for (int x = left; x < right; ++x) {
      a += p[x];
      b += q[x];
      aa += p[x] * p[x];
      bb += q[x] * q[x];
      ab += p[x] * q[x];
    }
  }
  const auto n = static_cast<float>((right - left) * (bottom - top));
  const float variances = (aa - a * a / n) * (bb - b * b / n);
  return variances > 1e-6f ? static_cast<double>((ab - a * b / n) / std::sqrt(variances)) : 0.0;
}

// Where the parabola through three equidistant values has its top, from the middle one.
double topOffset(double before, double middle, double after) {
  const double curvature = before - 2 * middle + after;
  return curvature < 0 ? std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5) : 0.0;
}

// Every second shift, then the neighbours of the best.
ThumbnailMatch bestShift(const Thumbnail& first, const Thumbnail& second, bool to_a_fraction) {
  const int reach_x = static_cast<int>(largest_shift * second.cols),
            reach_y = static_cast<int>(largest_shift * second.rows);
  double best = -2;
  int best_x = 0, best_y = 0;
  const auto consider = [&](int dx, int dy) {
    const double correlation = correlationAt(first, second, dx, dy);
    if (correlation <= best) return;
    best = correlation;
    best_x = dx;
    best_y = dy;
  };
  for (int dy = -reach_y / 2 * 2; dy <= reach_y; dy += 2) {
    for (int dx = -reach_x / 2 * 2; dx <= reach_x; dx += 2) consider(dx, dy);
  }
  const int coarse_x = best_x, coarse_y = best_y;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) consider(coarse_x + dx, coarse_y + dy);
  }
  ThumbnailMatch match{best, 0, Eigen::Vector2d(best_x, best_y)};
  if (to_a_fraction) {
    const auto at = [&](int dx, int dy) { return correlationAt(first, second, best_x + dx, best_y + dy); };
    match.shift += Eigen::Vector2d(topOffset(at(-1, 0), best, at(1, 0)), topOffset(at(0, -1), best, at(0, 1)));
  }
  return match;
}

// The image turned by `roll` about its centre: what lay at p is at centre + turn (p - centre) afterwards.
Thumbnail turned(const Thumbnail& image, double roll) {
  const double c = std::cos(roll), s = std::sin(roll);
  const double cx = 0.5 * (image.cols - 1), cy = 0.5 * (image.rows - 1);
  const cv::Matx23d turn(c, -s, cx - c * cx + s * cy, s, c, cy - s * cx - c * cy);
  Thumbnail result;
  cv::warpAffine(image, result, turn, image.size(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return result;
}

}  // namespace

Thumbnail makeThumbnail(const ImagePyramid& pyramid, const CameraMask* mask) {
  const cv::Mat& grey = pyramid.levels.front();
  const int height =
      std::max(8, static_cast<int>(std::lround(static_cast<double>(thumbnail_width) * grey.rows / grey.cols)));
  std::size_t level = 0;
  while (level + 1 < pyramid.levels.size() && pyramid.levels[level + 1].cols >= 2 * thumbnail_width) ++level;
  Thumbnail small, lighting;
  cv::Mat resized;
  cv::resize(pyramid.levels[level], resized, {thumbnail_width, height}, 0, 0, cv::INTER_AREA);
  resized.convertTo(small, CV_32F);
  const cv::Mat hidden = mask ? hiddenPart(mask->hidden, small.size()) : cv::Mat();
  if (mask) fillHidden(hidden, lighting_sigma, small);
  cv::GaussianBlur(small, lighting, {}, lighting_sigma, lighting_sigma, cv::BORDER_REFLECT_101);
  cv::GaussianBlur(small, small, {}, blur_sigma, blur_sigma, cv::BORDER_REFLECT_101);
  small -= lighting;
  if (mask) small.setTo(0, hidden);
  return small;
}

ThumbnailMatch matchShifted(const Thumbnail& first, const Thumbnail& second) { return bestShift(first, second, false); }

ThumbnailMatch matchTurned(const Thumbnail& first, const Thumbnail& second) {
  ThumbnailMatch best;
  for (int step = -roll_steps; step <= roll_steps; ++step) {
    const double roll = step * roll_step;
    ThumbnailMatch match = bestShift(first, step == 0 ? second : turned(second, roll), true);
    if (match.correlation <= best.correlation) continue;
    match.roll = roll;
    best = match;
  }
  return best;
}

Eigen::Quaterniond rotationOf(const Camera& camera, const ThumbnailMatch& match) {
  const Eigen::Vector2d middle(0.5 * (camera.width - 1), 0.5 * (camera.height - 1));
  const double scale = static_cast<double>(camera.width) / thumbnail_width;
  const Eigen::Vector3d in_second = bearing(camera, middle), in_first = bearing(camera, middle + scale * match.shift);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(match.roll, in_second));
  return (Eigen::Quaterniond::FromTwoVectors(in_second, in_first) * turn).normalized();
}

}  // namespace edgeslam
