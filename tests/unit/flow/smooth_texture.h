// A smooth random texture that is known at every sub-pixel position, so that an image may be shifted or warped exactly.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <opencv2/core.hpp>
#include <random>
#include <vector>

namespace edgeslam {

class SmoothTexture {
 public:
  // Cosine waves of random direction and of lengths from `shortest` to `longest` [px].
  explicit SmoothTexture(unsigned seed, double shortest = 14, double longest = 100) {
    std::mt19937 random(seed);
    const auto uniform = [&](double low, double high) {
      return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
    };
    constexpr int waves = 40;
    for (int i = 0; i < waves; ++i) {
      const double direction = uniform(0, 2 * M_PI);
      const double length = shortest * std::pow(longest / shortest, (i + 0.5) / waves);
      waves_.push_back(
          {2 * M_PI / length * std::cos(direction), 2 * M_PI / length * std::sin(direction), uniform(0, 2 * M_PI)});
    }
  }

  // Grey value, within 18 to 238.
  double operator()(double x, double y) const {
    double sum = 0;
    for (const Wave& wave : waves_) sum += std::cos(wave.x * x + wave.y * y + wave.phase);
    return 128 + 110 * std::tanh(0.35 * sum);
  }

  // Image whose pixel p shows the texture at from(p).
  template <typename From>
  cv::Mat render(const cv::Size& size, From from) const {
    cv::Mat image(size, CV_8U);
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        const Eigen::Vector2d at = from(Eigen::Vector2d(x, y));
        image.at<unsigned char>(y, x) = cv::saturate_cast<unsigned char>((*this)(at.x(), at.y()));
      }
    }
    return image;
  }

  // What is seen at p is seen at p + shift in the image.
  cv::Mat renderShifted(const cv::Size& size, const Eigen::Vector2d& shift) const {
    return render(size, [&](const Eigen::Vector2d& pixel) -> Eigen::Vector2d { return pixel - shift; });
  }

 private:
  struct Wave {
    double x, y, phase;
  };
  std::vector<Wave> waves_;
};

}  // namespace edgeslam
