// P1: what the difference of Gaussians tells about the edge in a pixel: where its zero line runs, and whether the signs
// and the slope of its surroundings are those of an edge (the tests of Tarrio and Pedre, "Realtime Edge-Based Visual
// Odometry for a Monocular Camera", ICCV 2015, section 3).
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace edgeslam {

constexpr int largest_fit_radius = 7;          // [px]
constexpr float least_slope_agreement = 0.7F;  // cosine between the plane's gradient and the normal

// Offset of the zero line of `dog` (CV_16S) from the centre of pixel (x, y) along its row (`along_row`) or column,
// within [-0.5, 0.5] [px]: where the line crosses more rows than columns, one pixel of each row finds it. NaN where the
// sign does not change next to this pixel, or the line is nearer to the neighbour. The pixel lies at least one pixel
// inside the image.
float offsetOfZero(const cv::Mat& dog, int x, int y, bool along_row);

// True where, among the (2 radius + 1)^2 pixels of `dog` around (x, y), |positive - negative| / all is at most
// `sign_balance` and the fitted plane rises in about the direction of `normal` (unit, from dark to bright). Where it
// falls the grey values' gradient is at its least, not at its greatest. The pixel lies at least `radius` pixels inside
// the image.
bool isEdgeLike(const cv::Mat& dog, int x, int y, const Eigen::Vector2f& normal, int radius, double sign_balance);

}  // namespace edgeslam
