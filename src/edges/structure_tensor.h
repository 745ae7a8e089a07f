// The structure tensor: how well, and in which direction, the grey values around a pixel tell where it is.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core/mat.hpp>

namespace edgeslam {

// Mean over a window of g g^T for the grey gradient g: eigenvalues l1 >= l2 [grey^2/px^2] and the unit direction of l1.
struct StructureTensor {
  float l1 = 0;
  float l2 = 0;
  Eigen::Vector2f direction = Eigen::Vector2f::UnitX();
};

// Sums over a window of the products of twice the gradient's components, by differences of the neighbours: right minus
// left, lower minus upper; at the image's border the missing neighbour is the border pixel itself [grey^2/4 px^2].
struct GradientProducts {
  int64_t xx = 0;
  int64_t xy = 0;
  int64_t yy = 0;
  int count = 0;  // of pixels
};

// Over the `window` x `window` pixels (odd) of `grey` (CV_8U) around the one nearest to `pixel`. A window that leaves
// the image is cut off at the border; of none where nothing is left of it.
GradientProducts gradientProducts(const cv::Mat& grey, const Eigen::Vector2f& pixel, int window);

// Zero of no pixels.
StructureTensor structureTensor(const GradientProducts& products);

// Structure tensor at a sub-pixel position of `grey`, over the window of gradientProducts.
StructureTensor structureTensor(const cv::Mat& grey, const Eigen::Vector2f& pixel, int window);

}  // namespace edgeslam
