// P3: edge points joined along the edge into chains (after Tarrio and Pedre, ICCV 2015, section 3).
#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>
#include <vector>

#include "edges/edge_detection.h"

namespace edgeslam {

// `index` (CV_32S) holds for each pixel the index of its point in `points`, or -1; points that it does not name are
// left out. Two points are joined where each is the other's best continuation along the edge, so a chain ends at a
// junction. Chains of fewer than `shortest_chain` points are dropped. Walking along `next`, the brighter side lies on
// the left hand as seen on the screen. A closed chain's last point is joined to its first.
EdgeMap joinChains(const std::vector<EdgePoint>& points, const std::vector<cv::Point>& cells, const cv::Mat& index,
                   int shortest_chain);

}  // namespace edgeslam
