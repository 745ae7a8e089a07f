// P3: for each edge pixel the neighbours with which its edge goes on, ahead and behind.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "edges/edge_pixels.h"

namespace edgeslam {

constexpr int not_named = -2;  // in place of a neighbour: the index does not name the point itself

// Finds for each point that `index` names (CV_32S, of one piece) the best continuation among the three pixels ahead
// along the edge, with the brighter side on the left hand as seen on the screen, and among the three behind; -1 where
// there is none, not_named where the index does not name the point. The points lie at least one pixel inside the image.
// `ahead` and `behind` have their number.
void chooseNeighbours(const std::vector<EdgePixel>& points, const cv::Mat& index, std::vector<int>& ahead,
                      std::vector<int>& behind);

// Keeps, of each point's choices, only those that are mutual: `next` ahead of a point is -1 where the point is not the
// one behind `next`, and the other way round. Both hold -1, not_named or indices of each other's entries.
void keepMutual(std::vector<int>& ahead, std::vector<int>& behind);

// What chooseNeighbours and keepMutual give, one point after the other.
void chooseNeighboursReference(const std::vector<EdgePixel>& points, const cv::Mat& index, std::vector<int>& ahead,
                               std::vector<int>& behind);
void keepMutualReference(std::vector<int>& ahead, std::vector<int>& behind);

constexpr float least_neighbour_agreement = 0.6F;  // dot product of the normals of two neighbours along an edge

constexpr float tan_of_half_octant = 0.41421356F;

// Direction of an edge in eighths of a turn, each of them centred at its direction: 0 is to the right, 2 is down.
int octant(const Eigen::Vector2f& direction);

// How far an entry of `index` is from its neighbour in that octant.
std::ptrdiff_t stepTo(int octant, const cv::Mat& index);

}  // namespace edgeslam
