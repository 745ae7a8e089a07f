#include "bench/known_warp.h"

#include <Eigen/LU>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "unit/edges/synthetic_image.h"
#include "unit/flow/smooth_texture.h"

namespace edgeslam {
namespace {

constexpr double gain = 1.1, bias = -12, noise_grey = 2, lens_sigma_px = 0.8;

using GreyAt = std::function<double(const Eigen::Vector2d&)>;

// 1 well inside of a shape whose edge is this far away [px], 0 outside, seen through a lens.
double covered(double distance_px) { return 0.5 + 0.5 * std::erf(distance_px / (lens_sigma_px * std::sqrt(2.0))); }

// Panels and discs laid one over the other.
GreyAt makePanels(const cv::Size& size) {
  struct Panel {
    Eigen::Vector2d centre, across, half_size;
    double grey;
    bool round;
  };
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Panel> panels;
  for (int i = 0; i < 24; ++i) {
    const double angle = M_PI * uniform(random);
    Panel panel;
    panel.centre = {uniform(random) * size.width, uniform(random) * size.height};
    panel.across = {std::cos(angle), std::sin(angle)};
    panel.half_size = {25 + 110 * uniform(random), 25 + 110 * uniform(random)};
    panel.grey = 40 + 150 * uniform(random);
    panel.round = i % 4 == 3;
    panels.push_back(panel);
  }
  return [panels](const Eigen::Vector2d& pixel) {
    double grey = 110;
    for (const Panel& panel : panels) {
      const Eigen::Vector2d off = pixel - panel.centre;
      const Eigen::Vector2d inside =
          panel.half_size - Eigen::Vector2d(std::abs(off.dot(panel.across)),
                                            std::abs(off.x() * panel.across.y() - off.y() * panel.across.x()));
      const double share =
          panel.round ? covered(panel.half_size.x() / 2 - off.norm()) : covered(inside.x()) * covered(inside.y());
      grey += share * (panel.grey - grey);
    }
    return grey;
  };
}

GreyAt makeTexture() {
  const SmoothTexture coarse(3, 30, 150), fine(4, 6, 25);
  return [coarse, fine](const Eigen::Vector2d& pixel) {
    return 20 + 0.5 * coarse(pixel.x(), pixel.y()) + 0.3 * fine(pixel.x(), pixel.y());
  };
}

cv::Mat render(const cv::Size& size, const GreyAt& grey, unsigned seed) {
  cv::Mat image(size, CV_8U);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) image.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(grey({x, y}));
  }
  return withNoise(image, noise_grey, seed);
}

}  // namespace

Eigen::Vector2d KnownWarp::invert(const Eigen::Vector2d& pixel) const { return linear.inverse() * (pixel - shift); }

Eigen::Vector2d KnownWarp::normalThere(const Eigen::Vector2d& normal) const {
  return (linear.inverse().transpose() * normal).normalized();
}

KnownWarp turnAndShift(const cv::Size& size, double degrees, double scale, const Eigen::Vector2d& shift) {
  const double angle = degrees * M_PI / 180;
  const Eigen::Vector2d centre(0.5 * size.width, 0.5 * size.height);
  KnownWarp warp;
  warp.linear << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  warp.linear *= scale;
  warp.shift = centre - warp.linear * centre + shift;
  return warp;
}

PicturePair renderPair(Picture picture, const cv::Size& size, const KnownWarp& warp) {
  const GreyAt grey = picture == Picture::texture ? makeTexture() : makePanels(size);
  const GreyAt moved = [&](const Eigen::Vector2d& pixel) { return gain * grey(warp.invert(pixel)) + bias; };
  return {render(size, grey, 1), render(size, moved, 2)};
}

}  // namespace edgeslam
