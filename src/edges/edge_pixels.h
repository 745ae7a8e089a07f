// P1: the pixels through which edges run: zero crossings of the difference of Gaussians with the signs and the slope of
// an edge around them, each with its sub-pixel position and normal.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "image/difference_of_gaussians.h"

namespace edgeslam {

struct EdgeOptions {
  double sigma = 1.78;              // of the narrower Gaussian [px]
  double sigma_ratio = 1.26;        // wider over narrower
  int plane_fit_radius = 2;         // an edge is told by a plane fitted to (2 r + 1)^2 pixels of the DoG [px]
  double sign_balance = 0.4;        // most |positive - negative| / all of the DoG's signs in that window
  double gradient_threshold = 1.5;  // least grey-value gradient across the edge [grey/px]
  int shortest_chain = 6;           // shorter chains are no edges [points]
};

struct EdgePixel {
  Eigen::Vector2f pixel;   // sub-pixel [px]
  Eigen::Vector2f normal;  // unit, from dark to bright
  float gradient = 0;      // of the grey values across the edge [grey/px]
  float offset = 0;        // from the centre of the cell, along the image axis nearer to the normal [px]
  cv::Point cell;          // the pixel that it lies in
};

// For one row of the image: the pixels that may hold an edge, and integers of the images around each.
struct EdgeCandidates {
  std::vector<uint8_t> marks;       // a bit a pixel
  std::vector<int32_t> x;           // [px]
  std::vector<int32_t> gradient_x;  // twice that of the blurred image
  std::vector<int32_t> gradient_y;
  std::vector<int32_t> before;  // the DoG, smoothed along the edge, a pixel before, in, and a pixel after this one
  std::vector<int32_t> here;
  std::vector<int32_t> after;
  std::vector<int32_t> slope_x;  // of the plane fitted to the DoG, in four summands
  std::vector<int32_t> slope_y;
  std::vector<int32_t> positive;  // pixels of the window where the DoG is, in four summands
};

struct EdgePixels {
  std::vector<EdgePixel> points;  // row by row
  EdgeCandidates candidates;
};

// No more points are looked for in an image of this size: a quarter of its pixels. Noise of whatever grain gives a
// fifth of them at most; only stripes as fine as the Gaussians give more.
inline size_t mostEdgePoints(const cv::Size& size) { return static_cast<size_t>(size.area()) / 4; }

// Fills `pixels` and `index` (CV_32S, of the images' size: index of the point in that pixel, or -1). Where there are
// more than mostEdgePoints the lowest rows are left out. Allocates where `pixels` was not used for this size.
void findEdgePixels(const DifferenceOfGaussians& images, const EdgeOptions& options, EdgePixels& pixels,
                    cv::Mat& index);

// What findEdgePixels gives, one pixel after the other.
void findEdgePixelsReference(const DifferenceOfGaussians& images, const EdgeOptions& options, EdgePixels& pixels,
                             cv::Mat& index);

// Shapes the memory and empties it: what findEdgePixels and its reference do first.
void prepareEdgePixels(const cv::Size& size, EdgePixels& pixels, cv::Mat& index);

// Edges are looked for in pixels that lie so far inside the image [px].
inline int edgeMargin(const EdgeOptions& options) { return options.plane_fit_radius + 2; }

// What the larger component of twice the blurred image's gradient is at least, where the gradient is steep enough.
int16_t leastDifference(const EdgeOptions& options);

}  // namespace edgeslam
