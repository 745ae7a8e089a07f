// P26, correspondences between two keyframes farther apart in viewpoint than flow can bridge: binary descriptors (ORB,
// Rublee et al. 2011) taken at our own edge points.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <utility>
#include <vector>

#include "places/place_view.h"

namespace edgeslam {

struct KeyframeMatchingOptions {
  int most_points = 600;         // described in each keyframe, corner-like ones first
  double largest_distance = 70;  // bits of 256 in which two descriptors may differ
  double ratio = 0.85;           // best distance over the best of those elsewhere in the image
  double elsewhere = 20;         // farther than this from the best match, a point is elsewhere [px]
  double same_place = 8;         // matching back must lead so near to the start [px]
};

struct DescribedPoints {
  std::vector<int> points;              // index of each described point
  std::vector<Eigen::Vector2f> pixels;  // of each of these
  std::vector<cv::Mat> descriptors;     // one a size of the patch: CV_8U, a row a described point
};

// Descriptors at `pixels` of `grey` (CV_8U) at three sizes of the patch. `roll` [rad]: how far the image is turned
// against the one that it is to be compared with.
DescribedPoints describePoints(const cv::Mat& grey, const std::vector<Eigen::Vector2f>& pixels, double roll);

// Pairs of entries (first, second) that are each other's best match over all sizes of the patch, ascending by the
// first.
std::vector<std::pair<int, int>> matchDescriptors(const DescribedPoints& first, const DescribedPoints& second,
                                                  const KeyframeMatchingOptions& options);

// Pairs of indices into the points of both views. The roll between the two images is that of the keyframes' poses,
// which drift leaves good enough for descriptors.
std::vector<std::pair<int, int>> matchKeyframes(const PlaceView& first, const PlaceView& second,
                                                const Pose& first_T_second, const KeyframeMatchingOptions& options);

}  // namespace edgeslam
