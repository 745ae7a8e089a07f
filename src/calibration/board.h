// Calibration boards: flat targets whose corners are each the meeting of two black and two white squares (X-corners).
// Board frame: x right, y down as printed, z away from the reader, origin at the corner with number 0 of a chessboard
// or ChArUco board and at the top-left tag's top-left corner of an AprilGrid.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace edgeslam {

enum class BoardKind {
  chessboard,  // columns x rows count the inner corners, as in OpenCV and ROS
  charuco,     // columns x rows count the squares, as in OpenCV (4.6 and newer): black at the top left
  aprilgrid    // columns x rows count the tags, as in Kalibr: number 0 at the bottom left, small squares between tags
};

enum class MarkerFamily { aruco_4x4, aruco_5x5, aruco_6x6, aruco_7x7, apriltag_36h11 };

struct Board {
  BoardKind kind = BoardKind::chessboard;
  int columns = 9, rows = 6;                      // of what the kind counts
  double square_m = 0.03;                         // side of a square; of a tag for an AprilGrid
  double marker_m = 0;                            // ChArUco: side of the markers in the white squares
  double spacing = 0;                             // AprilGrid: gap between tags over the tag's side, as in Kalibr
  MarkerFamily family = MarkerFamily::aruco_5x5;  // ChArUco: of the markers
};

// One line that names a board wherever the program is told about one, and that is printed on the board itself:
//   chessboard:9x6:30mm
//   charuco:8x6:30mm:22mm         squares' side, markers' side; then :4x4, :6x6, :7x7 where the markers are not 5x5
//   aprilgrid:6x6:25mm:0.3        tags' side, gap over side
// Lengths are in mm, cm or m (30mm, 3cm, 0.03m). Throws InputError that names the part and what was expected.
Board parseBoard(const std::string& text);
std::string boardText(const Board& board);

// A length with its unit ("30mm", "3 cm", "0.03m") in metres. Throws InputError with `name` where it is none, or is not
// 0.1 mm to 10 m.
double parseLength(const std::string& text, const std::string& name);
// "30mm", with as many decimals as it takes.
std::string lengthText(double length_m);

// Throws InputError where a number of columns or rows, a side or a ratio makes no board, or there are not so many
// markers.
void checkBoard(const Board& board);

// Positions of the corners in the board frame [m], by their numbers: row by row from the top left; for an AprilGrid
// four a tag, clockwise from its top left.
std::vector<Eigen::Vector2d> boardCorners(const Board& board);

// Number of tags or markers on the board.
int markerCount(const Board& board);
// The marker's top-left corner in the board frame, and the side of all [m].
Eigen::Vector2d markerOrigin(const Board& board, int marker);
double markerSide(const Board& board);

// "9 x 6 inner corners", "8 x 6 squares", "6 x 6 tags": for messages.
std::string boardSizeText(const Board& board);

}  // namespace edgeslam
