#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "calibration/calibration.h"
#include "files/format_text.h"
#include "geometry/median.h"

namespace edgeslam {
namespace {

constexpr double spacing_tolerance = 0.03;  // of a tag's side
constexpr std::size_t views_looked_at = 3;

std::optional<std::array<cv::Point2f, 4>> tagOf(const BoardSighting& sighting, int tag) {
  std::array<cv::Point2f, 4> corners;
  int found = 0;
  for (const BoardCorner& corner : sighting.corners) {
    if (corner.number / 4 != tag) continue;
    corners[static_cast<std::size_t>(corner.number % 4)] = {static_cast<float>(corner.pixel.x()),
                                                            static_cast<float>(corner.pixel.y())};
    ++found;
  }
  if (found != 4) return std::nullopt;
  return corners;
}

// Gap between tags over their side, as it looks from each tag to the one on its right.
double seenSpacing(const std::vector<BoardView>& views, const Board& board) {
  const std::array<cv::Point2f, 4> unit{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  std::vector<double> gaps;
  for (const BoardView& view : views) {
    for (int tag = 0; tag + 1 < markerCount(board); ++tag) {
      if (tag % board.columns == board.columns - 1) continue;
      const auto left = tagOf(view.sighting, tag), right = tagOf(view.sighting, tag + 1);
      if (!left || !right) continue;
      const cv::Mat tag_from_image = cv::getPerspectiveTransform(left->data(), unit.data());
      std::vector<cv::Point2f> places;
      cv::perspectiveTransform(std::vector<cv::Point2f>(right->begin(), right->end()), places, tag_from_image);
      // Its near side: farther out, the errors of a single tag's corners grow.
      gaps.push_back(0.5 * (places[0].x + places[3].x) - 1);
    }
  }
  if (gaps.size() < 10) return board.spacing;
  return upperMedian(std::move(gaps));
}

}  // namespace

std::string boardMismatch(const std::vector<BoardView>& views, const Board& board) {
  if (board.kind == BoardKind::aprilgrid) {
    const double seen = seenSpacing(views, board);
    if (std::abs(seen - board.spacing) <= spacing_tolerance) return "";
    return formatted("the gaps between the tags look like %.2f of a tag's side, not %.2f", seen, board.spacing);
  }
  if (board.kind == BoardKind::charuco) return "";
  // A part of a larger chessboard can be taken for the whole.
  std::vector<cv::Size> seen;
  for (std::size_t i = 0; i < std::min(views_looked_at, views.size()); ++i) {
    const cv::Size size = chessboardSeen(views[i * views.size() / views_looked_at].grey);
    if (size.area() > board.columns * board.rows) seen.push_back(size);
  }
  if (seen.size() < 2 || seen[0] != seen[1]) return "";
  return "a chessboard of " + std::to_string(seen[0].width) + " x " + std::to_string(seen[0].height) +
         " inner corners is seen, not one of " + boardSizeText(board);
}

}  // namespace edgeslam
