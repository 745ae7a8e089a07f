#include "calibration/board_drawing.h"

#include <algorithm>

#include "calibration/marker_detection.h"

namespace edgeslam {
namespace {

// Black fields of a chessboard of so many squares, black at the top left; `left`, `top`: of its first square.
void drawSquares(int columns, int rows, double side, std::vector<BoardRectangle>& black) {
  for (int row = 0; row < rows; ++row) {
    for (int column = row % 2; column < columns; column += 2) {
      const double left = (column - 1) * side, top = (row - 1) * side;
      black.push_back({left, top, left + side, top + side});
    }
  }
}

// Runs of black cells, a row at a time.
void drawMarker(const Board& board, int number, std::vector<BoardRectangle>& black) {
  const cv::Mat cells = markerCells(markerFamily(board), number);
  const int border = markerBorder(board), count = cells.rows + 2 * border;
  const Eigen::Vector2d origin = markerOrigin(board, number);
  const double side = markerSide(board);
  const auto isBlack = [&](int row, int column) {
    const int r = row - border, c = column - border;
    return r < 0 || c < 0 || r >= cells.rows || c >= cells.cols || cells.at<unsigned char>(r, c) == 0;
  };
  for (int row = 0; row < count; ++row) {
    for (int first = 0; first < count; ++first) {
      if (!isBlack(row, first)) continue;
      int end = first;
      while (end < count && isBlack(row, end)) ++end;
      black.push_back({origin.x() + side * first / count, origin.y() + side * row / count,
                       origin.x() + side * end / count, origin.y() + side * (row + 1) / count});
      first = end;
    }
  }
}

// The small squares that touch the tags' corners.
void drawGapSquares(const Board& board, std::vector<BoardRectangle>& black) {
  const double side = board.square_m, gap = side * board.spacing;
  for (int row = 0; row <= board.rows; ++row) {
    for (int column = 0; column <= board.columns; ++column) {
      const double right = column * (side + gap), bottom = row * (side + gap);
      black.push_back({right - gap, bottom - gap, right, bottom});
    }
  }
}

}  // namespace

BoardDrawing drawBoard(const Board& board) {
  BoardDrawing drawing;
  const int more = board.kind == BoardKind::chessboard ? 1 : 0;
  if (board.kind == BoardKind::aprilgrid) {
    drawGapSquares(board, drawing.black);
  } else {
    drawSquares(board.columns + more, board.rows + more, board.square_m, drawing.black);
  }
  for (int marker = 0; marker < markerCount(board); ++marker) drawMarker(board, marker, drawing.black);
  drawing.extent = drawing.black.front();
  for (const BoardRectangle& r : drawing.black) {
    drawing.extent.left_m = std::min(drawing.extent.left_m, r.left_m);
    drawing.extent.top_m = std::min(drawing.extent.top_m, r.top_m);
    drawing.extent.right_m = std::max(drawing.extent.right_m, r.right_m);
    drawing.extent.bottom_m = std::max(drawing.extent.bottom_m, r.bottom_m);
  }
  return drawing;
}

}  // namespace edgeslam
