// P1: sub-pixel position and direction of a zero line of the difference of Gaussians, from a plane fitted around a
// pixel (as Tarrio and Pedre, "Realtime Edge-Based Visual Odometry for a Monocular Camera", ICCV 2015, section 3).
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace edgeslam {

constexpr int kLargestFitRadius = 4;  // [px]

// Signed distance [px] along `normal` (unit, from dark to bright) from the centre of pixel (x, y) to the zero line of
// `dog` (CV_16S), from the (2 radius + 1)^2 pixels around it; the pixel lies at least radius + 1 pixels inside the
// image. NaN where this is no edge: |positive - negative| / all of the signs exceeds `sign_balance`, or the fitted
// plane doesn't rise in about the direction of `normal` (a DoG that falls there tells a least gradient, not an edge).
float distanceToZero(const cv::Mat& dog, int x, int y, const Eigen::Vector2f& normal, int radius, double sign_balance);

}  // namespace edgeslam
