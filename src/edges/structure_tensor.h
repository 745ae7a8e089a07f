// The structure tensor: how well, and in which direction, the grey values around a pixel tell where it is.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "image/gradient_products.h"

namespace edgeslam {

// Mean over a window of g g^T for the grey gradient g: eigenvalues l1 >= l2 [grey^2/px^2] and the unit direction of l1.
struct StructureTensor {
  float l1 = 0;
  float l2 = 0;
  Eigen::Vector2f direction = Eigen::Vector2f::UnitX();
};

// Structure tensor at a sub-pixel position of `grey` (CV_8U), over the `window` x `window` pixels (odd) around the
// nearest pixel, with central differences. A window that leaves the image is cut off at the border; zero where nothing
// is left of it.
StructureTensor structureTensor(const cv::Mat& grey, const Eigen::Vector2f& pixel, int window);

// In two steps, for those who need the direction of few: the sums over the window, and what of them follows.
GradientProducts gradientProductsAround(const cv::Mat& grey, const Eigen::Vector2f& pixel, int window);
struct Eigenvalues {
  float l1 = 0;
  float l2 = 0;
};
Eigenvalues eigenvalues(const GradientProducts& products);
StructureTensor structureTensor(const GradientProducts& products);

}  // namespace edgeslam
