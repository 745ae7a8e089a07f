#include "calibration/grid_tag_detection.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>

namespace edgeslam {
namespace {

using Quadrangle = std::array<Eigen::Vector2d, 4>;

constexpr int cell_pixels = 6;  // of a tag that is looked at from the front
constexpr int most_wrong_cells = 4;
constexpr double least_side_px = 12;
constexpr int enlarged = 1000;  // images with a longer side below this are looked at enlarged [px]

double shortestSide(const Quadrangle& q) {
  double shortest = 1e9;
  for (std::size_t i = 0; i < 4; ++i) shortest = std::min(shortest, (q[i] - q[(i + 1) % 4]).norm());
  return shortest;
}

// The corners moved outwards, along both sides by as much as black was eaten.
Quadrangle grown(const Quadrangle& q, double by_px) {
  Quadrangle larger;
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d& next = q[(i + 1) % 4];
    const Eigen::Vector2d& before = q[(i + 3) % 4];
    larger[i] = q[i] + by_px * ((q[i] - next).normalized() + (q[i] - before).normalized());
  }
  return larger;
}

// The tag's cells as they look, 1 white, 0 black, border included; empty where the border is not black.
cv::Mat readCells(const cv::Mat& grey, const Quadrangle& corners, int cells, int border) {
  const int count = cells + 2 * border, side = count * cell_pixels;
  std::array<cv::Point2f, 4> from, to;
  for (std::size_t i = 0; i < 4; ++i) {
    from[i] = {static_cast<float>(corners[i].x()), static_cast<float>(corners[i].y())};
    to[i] = {i == 1 || i == 2 ? static_cast<float>(side) - 0.5F : -0.5F,
             i >= 2 ? static_cast<float>(side) - 0.5F : -0.5F};
  }
  cv::Mat upright, means, bits;
  cv::warpPerspective(grey, upright, cv::getPerspectiveTransform(from.data(), to.data()), {side, side});
  cv::threshold(upright, bits, 0, 1, cv::THRESH_BINARY | cv::THRESH_OTSU);
  bits.convertTo(bits, CV_32F);
  cv::resize(bits, means, {count, count}, 0, 0, cv::INTER_AREA);
  const cv::Mat inner = means(cv::Rect(border, border, cells, cells)) > 0.5F;
  const int white_in_border = cv::countNonZero(means > 0.5F) - cv::countNonZero(inner);
  return white_in_border <= most_wrong_cells ? cv::Mat(inner / 255) : cv::Mat();
}

// The tag that looks like the cells, turned by so many quarters; number -1 where none does.
struct Match {
  int number = -1, quarters = 0, wrong = most_wrong_cells + 1;
};

Match matchTag(cv::Mat cells, const std::vector<cv::Mat>& tags) {
  Match best;
  for (int quarters = 0; quarters < 4; ++quarters) {
    for (std::size_t i = 0; i < tags.size(); ++i) {
      const int wrong = cv::countNonZero(cells != tags[i]);
      if (wrong < best.wrong) best = {static_cast<int>(i), quarters, wrong};
    }
    cv::rotate(cells.clone(), cells, cv::ROTATE_90_COUNTERCLOCKWISE);
  }
  return best;
}

}  // namespace

std::vector<DetectedMarker> detectGridTags(const cv::Mat& grey, const Board& board) {
  const MarkerFamily family = markerFamily(board);
  const int border = markerBorder(board);
  std::vector<cv::Mat> tags;
  for (int i = 0; i < markerCount(board); ++i) tags.push_back(markerCells(family, i));

  const double scale = std::max(grey.cols, grey.rows) < enlarged ? 2 : 1;
  cv::Mat image;
  cv::resize(grey, image, {}, scale, scale, cv::INTER_LINEAR);
  std::map<int, std::pair<int, DetectedMarker>> best;  // by number, with the wrong cells
  for (const int eaten_px : {1, 2, 3}) {
    cv::Mat eaten;
    cv::dilate(image, eaten, cv::getStructuringElement(cv::MORPH_RECT, {2 * eaten_px + 1, 2 * eaten_px + 1}));
    for (const Quadrangle& found : darkQuadrangles(eaten)) {
      if (shortestSide(found) < least_side_px) continue;
      const Quadrangle corners = grown(found, eaten_px);
      const cv::Mat cells = readCells(image, corners, tags.front().rows, border);
      if (cells.empty()) continue;
      const Match match = matchTag(cells, tags);
      if (match.number < 0) continue;
      const auto known = best.find(match.number);
      if (known != best.end() && known->second.first <= match.wrong) continue;
      DetectedMarker marker;
      marker.number = match.number;
      for (std::size_t i = 0; i < 4; ++i) {
        const Eigen::Vector2d& corner = corners[(i + static_cast<std::size_t>(match.quarters)) % 4];
        marker.corners[i] = (corner.array() + 0.5) / scale - 0.5;
      }
      best[match.number] = {match.wrong, marker};
    }
  }
  std::vector<DetectedMarker> markers;
  for (const auto& [number, found] : best) markers.push_back(found.second);
  return markers;
}

}  // namespace edgeslam
