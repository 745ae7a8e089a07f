// Finds a calibration board in an image, whole or, where it has markers, in part.
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "calibration/board.h"

namespace edgeslam {

struct BoardCorner {
  int number = 0;         // as in boardCorners()
  Eigen::Vector2d pixel;  // distorted [px]
};

struct BoardSighting {
  std::vector<BoardCorner> corners;  // by growing number, at least six
  double blur_px = 0;                // standard deviation of the Gaussian that the edges look blurred with, about
  double square_px = 0;              // mean side of a square (a tag) in the image
};

// The board in a grey image (CV_8U); nothing where it is not found. A chessboard must be seen whole.
std::optional<BoardSighting> detectBoard(const cv::Mat& grey, const Board& board);

// The inner corners that a chessboard in the image has, the larger number first; empty where none is found.
cv::Size chessboardSeen(const cv::Mat& grey);

// What kind of board is seen instead where `board` was not found, or not whole: "a chessboard of 7 x 5 inner corners";
// empty where none is.
std::string otherBoardSeen(const cv::Mat& grey, const Board& board);

}  // namespace edgeslam
