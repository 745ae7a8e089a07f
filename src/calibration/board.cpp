#include "calibration/board.h"

#include <array>
#include <cmath>
#include <sstream>
#include <utility>

#include "edgeslam/input_error.h"
#include "files/text_file.h"

namespace edgeslam {
namespace {

constexpr std::array<std::pair<const char*, BoardKind>, 3> kinds{
    {{"chessboard", BoardKind::chessboard}, {"charuco", BoardKind::charuco}, {"aprilgrid", BoardKind::aprilgrid}}};
constexpr std::array<std::pair<const char*, MarkerFamily>, 4> families{{{"4x4", MarkerFamily::aruco_4x4},
                                                                        {"5x5", MarkerFamily::aruco_5x5},
                                                                        {"6x6", MarkerFamily::aruco_6x6},
                                                                        {"7x7", MarkerFamily::aruco_7x7}}};

std::vector<std::string> splitAtColons(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ':');) parts.push_back(part);
  return parts;
}

[[noreturn]] void fail(const std::string& text, const std::string& problem) {
  throw InputError("the board '" + text + "': " + problem +
                   "; expected chessboard:9x6:30mm, charuco:8x6:30mm:22mm or aprilgrid:6x6:25mm:0.3");
}

int parseCount(const std::string& board, const std::string& text) {
  const std::optional<double> number = parseNumber(text);
  if (!number || *number != std::floor(*number) || *number < 1 || *number > 1000) {
    fail(board, "'" + text + "' is no number of columns or rows");
  }
  return static_cast<int>(*number);
}

void parseSize(const std::string& text, const std::string& size, Board& board) {
  const std::size_t cross = size.find('x');
  if (cross == std::string::npos) fail(text, "'" + size + "' is no size such as 9x6");
  board.columns = parseCount(text, size.substr(0, cross));
  board.rows = parseCount(text, size.substr(cross + 1));
}

std::string numberText(double value) {
  std::ostringstream text;
  text.precision(7);
  text << value;
  return text.str();
}

}  // namespace

double parseLength(const std::string& text, const std::string& name) {
  const std::size_t unit_at = text.find_first_of("mc");
  const std::string unit = unit_at == std::string::npos ? "" : text.substr(unit_at);
  const std::string digits = text.substr(0, text.find_last_not_of(' ', unit_at == 0 ? 0 : unit_at - 1) + 1);
  const std::optional<double> number = parseNumber(digits);
  const double factor = unit == "mm" ? 1e-3 : unit == "cm" ? 1e-2 : unit == "m" ? 1 : 0;
  if (!number || factor == 0)
    throw InputError(name + " must be a length with its unit, such as 30mm, not '" + text + "'");
  const double length_m = *number * factor;
  if (!(length_m >= 1e-4 && length_m <= 10)) throw InputError(name + " must be 0.1mm to 10m, not '" + text + "'");
  return length_m;
}

std::string lengthText(double length_m) { return numberText(length_m * 1e3) + "mm"; }

Board parseBoard(const std::string& text) {
  const std::vector<std::string> parts = splitAtColons(text);
  Board board;
  bool known = false;
  for (const auto& [name, kind] : kinds) {
    if (parts.empty() || parts[0] != name) continue;
    board.kind = kind;
    known = true;
  }
  if (!known) fail(text, "'" + (parts.empty() ? "" : parts[0]) + "' is no kind of board");
  const std::size_t least = board.kind == BoardKind::chessboard ? 3 : 4;
  const std::size_t most = board.kind == BoardKind::charuco ? 5 : least;
  if (parts.size() < least || parts.size() > most) {
    fail(text, "has " + std::to_string(parts.size()) + " parts between colons");
  }
  parseSize(text, parts[1], board);
  board.square_m = parseLength(parts[2], "the board's square or tag");
  if (board.kind == BoardKind::charuco) board.marker_m = parseLength(parts[3], "the board's marker");
  if (board.kind == BoardKind::aprilgrid) {
    const std::optional<double> spacing = parseNumber(parts[3]);
    if (!spacing) fail(text, "'" + parts[3] + "' is no ratio of gap to tag");
    board.spacing = *spacing;
  }
  if (parts.size() == 5) {
    known = false;
    for (const auto& [name, family] : families) {
      if (parts[4] != name) continue;
      board.family = family;
      known = true;
    }
    if (!known) fail(text, "'" + parts[4] + "' is no family of markers (4x4, 5x5, 6x6, 7x7)");
  }
  checkBoard(board);
  return board;
}

std::string boardText(const Board& board) {
  std::string text;
  for (const auto& [name, kind] : kinds) {
    if (kind == board.kind) text = name;
  }
  text += ":" + std::to_string(board.columns) + "x" + std::to_string(board.rows) + ":" + lengthText(board.square_m);
  if (board.kind == BoardKind::aprilgrid) return text + ":" + numberText(board.spacing);
  if (board.kind == BoardKind::chessboard) return text;
  text += ":" + lengthText(board.marker_m);
  for (const auto& [name, family] : families) {
    if (family == board.family && family != MarkerFamily::aruco_5x5) text += std::string(":") + name;
  }
  return text;
}

void checkBoard(const Board& board) {
  const int least = board.kind == BoardKind::aprilgrid ? 1 : 3;
  if (board.columns < least || board.rows < least || board.columns > 40 || board.rows > 40 ||
      board.columns * board.rows < 2) {
    throw InputError("a board of " + boardSizeText(board) + " cannot be used; each number must be " +
                     std::to_string(least) + " to 40");
  }
  if (board.kind == BoardKind::charuco &&
      !(board.marker_m > 0.3 * board.square_m && board.marker_m < 0.95 * board.square_m)) {
    throw InputError("a ChArUco board's markers must be 0.3 to 0.95 of its squares (" + lengthText(board.square_m) +
                     "), not " + lengthText(board.marker_m));
  }
  if (board.kind == BoardKind::aprilgrid && !(board.spacing >= 0.05 && board.spacing <= 1)) {
    throw InputError("an AprilGrid's gap must be 0.05 to 1 of a tag's side, not " + numberText(board.spacing));
  }
  const int available = board.kind == BoardKind::aprilgrid ? 587 : 1000;
  if (markerCount(board) > available) {
    throw InputError("a board of " + boardSizeText(board) + " takes " + std::to_string(markerCount(board)) +
                     " markers, there are " + std::to_string(available));
  }
}

std::vector<Eigen::Vector2d> boardCorners(const Board& board) {
  std::vector<Eigen::Vector2d> corners;
  if (board.kind == BoardKind::aprilgrid) {
    const double a = board.square_m;
    for (int tag = 0; tag < markerCount(board); ++tag) {
      const Eigen::Vector2d origin = markerOrigin(board, tag);
      for (const auto& [x, y] : {std::pair(0.0, 0.0), {a, 0.0}, {a, a}, {0.0, a}})
        corners.emplace_back(origin.x() + x, origin.y() + y);
    }
    return corners;
  }
  const int fewer = board.kind == BoardKind::charuco ? 1 : 0;
  for (int row = 0; row < board.rows - fewer; ++row) {
    for (int column = 0; column < board.columns - fewer; ++column) {
      corners.emplace_back(column * board.square_m, row * board.square_m);
    }
  }
  return corners;
}

int markerCount(const Board& board) {
  if (board.kind == BoardKind::chessboard) return 0;
  const int fields = board.columns * board.rows;
  return board.kind == BoardKind::aprilgrid ? fields : fields / 2;
}

Eigen::Vector2d markerOrigin(const Board& board, int marker) {
  if (board.kind == BoardKind::aprilgrid) {
    const double pitch = board.square_m * (1 + board.spacing);
    return {(marker % board.columns) * pitch, (board.rows - 1 - marker / board.columns) * pitch};
  }
  // White squares are those with an odd sum of column and row; markers go row by row.
  int row = 0, before = 0;
  const auto whiteInRow = [&](int r) { return r % 2 == 0 ? board.columns / 2 : (board.columns + 1) / 2; };
  while (before + whiteInRow(row) <= marker) before += whiteInRow(row++);
  const int column = 2 * (marker - before) + (row % 2 == 0 ? 1 : 0);
  const double margin = 0.5 * (board.square_m - board.marker_m);
  return {(column - 1) * board.square_m + margin, (row - 1) * board.square_m + margin};
}

double markerSide(const Board& board) {
  return board.kind == BoardKind::charuco ? board.marker_m : board.kind == BoardKind::aprilgrid ? board.square_m : 0;
}

std::string boardSizeText(const Board& board) {
  const char* what = board.kind == BoardKind::chessboard ? " inner corners"
                     : board.kind == BoardKind::charuco  ? " squares"
                                                         : " tags";
  return std::to_string(board.columns) + " x " + std::to_string(board.rows) + what;
}

}  // namespace edgeslam
