// Square markers (ArUco, AprilTag 36h11) in an image and their patterns. All but markersCanBeFound() throws InputError
// where the library that finds them is not installed.
#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "calibration/board.h"

namespace edgeslam {

// Whether that library is installed.
bool markersCanBeFound();

struct DetectedMarker {
  int number = 0;
  std::array<Eigen::Vector2d, 4> corners;  // [px] of its black square, clockwise from the top left as it is printed
};

// Markers of the family in a grey image (CV_8U), in no order, each number once: one that is there twice is left out.
// `border`: width of the black border in cells.
std::vector<DetectedMarker> detectMarkers(const cv::Mat& grey, MarkerFamily family, int border);

// Quadrangles in the image that may be dark squares, clockwise from any corner; most are none.
std::vector<std::array<Eigen::Vector2d, 4>> darkQuadrangles(const cv::Mat& grey);

// The marker's cells without its border, CV_8U, 1 white, 0 black, as it is printed upright.
cv::Mat markerCells(MarkerFamily family, int number);

// Width of the border in cells of the markers on a board: 1, and 2 for AprilGrids, as Kalibr has it.
inline int markerBorder(const Board& board) { return board.kind == BoardKind::aprilgrid ? 2 : 1; }
// Family of the markers on a board.
inline MarkerFamily markerFamily(const Board& board) {
  return board.kind == BoardKind::aprilgrid ? MarkerFamily::apriltag_36h11 : board.family;
}

}  // namespace edgeslam
