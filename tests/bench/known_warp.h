// Two pictures of a plane between which the motion of every pixel is known: the second is turned, scaled, shifted,
// brighter, and has noise of its own.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace edgeslam {

// Where a pixel of the first picture is in the second.
struct KnownWarp {
  Eigen::Matrix2d linear = Eigen::Matrix2d::Identity();
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();  // [px]

  Eigen::Vector2d apply(const Eigen::Vector2d& pixel) const { return linear * pixel + shift; }
  Eigen::Vector2d invert(const Eigen::Vector2d& pixel) const;
  // Of a straight line with this unit normal, the normal that it has in the second picture.
  Eigen::Vector2d normalThere(const Eigen::Vector2d& normal) const;
};

// A turn by `degrees` and a change of size about the picture's centre, and a shift [px].
KnownWarp turnAndShift(const cv::Size& size, double degrees, double scale, const Eigen::Vector2d& shift);

struct PicturePair {
  cv::Mat first, second;  // CV_8U
};

enum class Picture {
  texture,    // structure of all sizes: what corners and flow like
  edges_only  // bare panels: straight and curved edges between flat areas
};

PicturePair renderPair(Picture picture, const cv::Size& size, const KnownWarp& warp);

}  // namespace edgeslam
