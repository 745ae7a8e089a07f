// What is black on a board, as rectangles: for printing it, and for tests that look at one.
#pragma once

#include <vector>

#include "calibration/board.h"

namespace edgeslam {

struct BoardRectangle {
  double left_m = 0, top_m = 0, right_m = 0, bottom_m = 0;  // board frame
};

struct BoardDrawing {
  std::vector<BoardRectangle> black;  // they may touch, and do not overlap
  BoardRectangle extent;              // of all that is black
};

BoardDrawing drawBoard(const Board& board);

}  // namespace edgeslam
