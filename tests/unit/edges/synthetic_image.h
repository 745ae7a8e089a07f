// Images whose edges are known exactly: grey values follow an error function across the edge, as a sharp edge seen
// through a Gaussian lens does.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <random>

#include "geometry/camera.h"

namespace edgeslam {

inline const cv::Size drawing_size{320, 240};  // [px]

// Of drawn images of that size: what is straight in space is straight in them.
inline Camera cameraOfDrawing() {
  Camera camera;
  camera.width = drawing_size.width;
  camera.height = drawing_size.height;
  camera.fx = camera.fy = 300;
  camera.cx = 159.5;
  camera.cy = 119.5;
  return camera;
}

inline cv::Mat flatDrawing(int grey) { return cv::Mat(drawing_size, CV_8U, cv::Scalar(grey)); }

// Of an image whose pixels have noise of that standard deviation, half of theirs: a central difference is half the
// difference of two.
inline double gradientVariance(double sigma) { return 0.5 * sigma * sigma; }

// `signed_distance(x, y)` to the edge [px], positive on the bright side.
template <typename SignedDistance>
cv::Mat renderEdge(const cv::Size& size, SignedDistance signed_distance, double dark = 60, double bright = 180,
                   double lens_sigma = 0.6) {
  cv::Mat image(size, CV_8U);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const double share = 0.5 + 0.5 * std::erf(signed_distance(x, y) / (lens_sigma * std::sqrt(2.0)));
      image.at<uint8_t>(y, x) = cv::saturate_cast<uint8_t>(dark + (bright - dark) * share);
    }
  }
  return image;
}

struct Line {
  Eigen::Vector2d normal;  // unit, to the bright side
  double offset;           // normal.dot(p) on the line [px]

  double distance(double x, double y) const { return normal.x() * x + normal.y() * y - offset; }
};

// Through the point (x, y), with the normal at `degrees` from the x axis.
inline Line lineThrough(double x, double y, double degrees) {
  const double angle = degrees * M_PI / 180;
  const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
  return {normal, normal.dot(Eigen::Vector2d(x, y))};
}

inline cv::Mat renderLine(const cv::Size& size, const Line& line, double dark = 60, double bright = 180) {
  return renderEdge(
      size, [&](double x, double y) { return line.distance(x, y); }, dark, bright);
}

// A bright disc on dark ground.
inline cv::Mat renderDisc(const cv::Size& size, const Eigen::Vector2d& centre, double radius) {
  return renderEdge(size, [&](double x, double y) { return radius - std::hypot(x - centre.x(), y - centre.y()); });
}

// Sharp squares of side `side` [px], the first corner between four of them at (side - 0.5, side - 0.5).
inline cv::Mat renderCheckerboard(const cv::Size& size, int side) {
  cv::Mat image(size, CV_8U);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) image.at<uint8_t>(y, x) = (x / side + y / side) % 2 == 0 ? 60 : 180;
  }
  return image;
}

inline cv::Mat withNoise(const cv::Mat& image, double sigma, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> noise(0, sigma);
  cv::Mat noisy = image.clone();
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      noisy.at<uint8_t>(y, x) = cv::saturate_cast<uint8_t>(image.at<uint8_t>(y, x) + noise(generator));
    }
  }
  return noisy;
}

// Blobs of all sizes, the same for the same seed.
inline cv::Mat renderTexture(const cv::Size& size, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  cv::Mat image(size, CV_8U, cv::Scalar(100));
  for (int blob = 0; blob < 120; ++blob) {
    const Eigen::Vector2d centre(uniform(generator) * size.width, uniform(generator) * size.height);
    const double radius = 4 + 20 * uniform(generator);
    const double grey = 30 + 200 * uniform(generator);
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        if (std::hypot(x - centre.x(), y - centre.y()) < radius)
          image.at<uint8_t>(y, x) = cv::saturate_cast<uint8_t>(grey);
      }
    }
  }
  return image;
}

}  // namespace edgeslam
