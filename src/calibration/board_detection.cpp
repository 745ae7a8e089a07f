#include "calibration/board_detection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "calibration/grid_tag_detection.h"
#include "calibration/marker_detection.h"
#include "geometry/median.h"

namespace edgeslam {
namespace {

constexpr int largest_side = 1400;  // of the image that chessboards are looked for in [px]
constexpr int largest_window = 10;  // half the side of the window that a corner is refined in [px]
constexpr std::size_t fewest_corners = 6;

cv::Point2f toPoint(const Eigen::Vector2d& v) { return {static_cast<float>(v.x()), static_cast<float>(v.y())}; }

bool isInside(const cv::Mat& grey, const cv::Point2f& p, float border) {
  return p.x >= border && p.y >= border && p.x <= static_cast<float>(grey.cols - 1) - border &&
         p.y <= static_cast<float>(grey.rows - 1) - border;
}

// Moves corners to the nearest saddle of the grey values; drops those that would go further than the window reaches.
void refineCorners(const cv::Mat& grey, int window, std::vector<int>& numbers, std::vector<cv::Point2f>& pixels) {
  if (pixels.empty()) return;
  const int half = std::clamp(window, 2, largest_window);
  std::vector<cv::Point2f> refined = pixels;
  cv::cornerSubPix(grey, refined, {half, half}, {-1, -1}, {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 30, 1e-3});
  std::vector<int> kept_numbers;
  std::vector<cv::Point2f> kept;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const cv::Point2f shift = refined[i] - pixels[i];
    if (!(std::hypot(shift.x, shift.y) < static_cast<float>(half)) || !isInside(grey, refined[i], 2)) continue;
    kept.push_back(refined[i]);
    kept_numbers.push_back(numbers[i]);
  }
  numbers = kept_numbers;
  pixels = kept;
}

struct FoundCorners {
  std::vector<int> numbers;
  std::vector<cv::Point2f> pixels;
};

FoundCorners findChessboard(const cv::Mat& grey, const Board& board) {
  const int side = std::max(grey.cols, grey.rows);
  const double scale = side > largest_side ? static_cast<double>(largest_side) / side : 1;
  cv::Mat small = grey;
  if (scale < 1) cv::resize(grey, small, {}, scale, scale, cv::INTER_AREA);
  FoundCorners found;
  const cv::Size size(board.columns, board.rows);
  if (!cv::findChessboardCornersSB(small, size, found.pixels, cv::CALIB_CB_NORMALIZE_IMAGE)) return {};
  for (cv::Point2f& p : found.pixels) {
    p.x = static_cast<float>((p.x + 0.5) / scale - 0.5);
    p.y = static_cast<float>((p.y + 0.5) / scale - 0.5);
  }
  for (int i = 0; i < static_cast<int>(found.pixels.size()); ++i) found.numbers.push_back(i);
  if (scale < 1) refineCorners(grey, static_cast<int>(std::ceil(2 / scale)), found.numbers, found.pixels);
  return found;
}

std::vector<DetectedMarker> markersOf(const cv::Mat& grey, const Board& board) {
  std::vector<DetectedMarker> markers = detectMarkers(grey, markerFamily(board), markerBorder(board));
  markers.erase(std::remove_if(markers.begin(), markers.end(),
                               [&](const DetectedMarker& m) { return m.number >= markerCount(board); }),
                markers.end());
  return markers;
}

// Mean side of the markers in the image [px].
double meanSide(const std::vector<DetectedMarker>& markers) {
  double sum = 0;
  for (const DetectedMarker& marker : markers) {
    for (std::size_t i = 0; i < 4; ++i) sum += (marker.corners[i] - marker.corners[(i + 1) % 4]).norm();
  }
  return markers.empty() ? 0 : sum / (4 * static_cast<double>(markers.size()));
}

FoundCorners findAprilGrid(const cv::Mat& grey, const Board& board) {
  const std::vector<DetectedMarker> markers = detectGridTags(grey, board);
  FoundCorners found;
  for (const DetectedMarker& marker : markers) {
    for (int i = 0; i < 4; ++i) {
      found.numbers.push_back(4 * marker.number + i);
      found.pixels.push_back(toPoint(marker.corners[static_cast<std::size_t>(i)]));
    }
  }
  const double reach = std::min(board.spacing, 0.2) * 0.8 * meanSide(markers);
  refineCorners(grey, static_cast<int>(std::lround(reach)), found.numbers, found.pixels);
  return found;
}

// The squares' corners, where the markers about each say that it must be.
FoundCorners findCharuco(const cv::Mat& grey, const Board& board) {
  const std::vector<DetectedMarker> markers = markersOf(grey, board);
  const std::vector<Eigen::Vector2d> corners = boardCorners(board);
  FoundCorners found;
  for (std::size_t number = 0; number < corners.size(); ++number) {
    std::vector<cv::Point2f> on_board, in_image;
    for (const DetectedMarker& marker : markers) {
      const Eigen::Vector2d origin = markerOrigin(board, marker.number);
      const double side = board.marker_m;
      const Eigen::Vector2d middle = origin + Eigen::Vector2d(side, side) / 2;
      if ((middle - corners[number]).lpNorm<Eigen::Infinity>() > board.square_m) continue;
      const std::array<Eigen::Vector2d, 4> places{origin, origin + Eigen::Vector2d(side, 0),
                                                  origin + Eigen::Vector2d(side, side),
                                                  origin + Eigen::Vector2d(0, side)};
      for (std::size_t i = 0; i < 4; ++i) {
        on_board.push_back(toPoint((places[i] - corners[number]) / board.square_m));
        in_image.push_back(toPoint(marker.corners[i]));
      }
    }
    if (on_board.empty()) continue;
    const cv::Mat homography = cv::findHomography(on_board, in_image);
    if (homography.empty() || std::abs(homography.at<double>(2, 2)) < 1e-9) continue;
    const cv::Point2f pixel(static_cast<float>(homography.at<double>(0, 2) / homography.at<double>(2, 2)),
                            static_cast<float>(homography.at<double>(1, 2) / homography.at<double>(2, 2)));
    if (!isInside(grey, pixel, 2)) continue;
    found.numbers.push_back(static_cast<int>(number));
    found.pixels.push_back(pixel);
  }
  const double margin = 0.5 * (board.square_m / board.marker_m - 1) * meanSide(markers);
  refineCorners(grey, static_cast<int>(std::lround(margin)), found.numbers, found.pixels);
  return found;
}

// Mean distance in the image between corners that are a square (a tag) apart on the board [px].
double meanSquare(const std::vector<BoardCorner>& corners, const Board& board) {
  const std::vector<Eigen::Vector2d> places = boardCorners(board);
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    for (std::size_t j = i + 1; j < corners.size(); ++j) {
      const double apart =
          (places[static_cast<std::size_t>(corners[i].number)] - places[static_cast<std::size_t>(corners[j].number)])
              .norm();
      if (std::abs(apart - board.square_m) > 1e-6 * board.square_m) continue;
      sum += (corners[i].pixel - corners[j].pixel).norm();
      ++count;
    }
  }
  return count > 0 ? sum / count : 0;
}

// Steepest slope of the grey values along one edge of a corner, and along the other, which lies across: [grey/px].
std::array<double, 2> slopesOfEdges(const cv::Mat& dx, const cv::Mat& dy) {
  Eigen::Vector2d first(0, 0);
  const auto gradientAt = [&](int y, int x) { return Eigen::Vector2d(dx.at<float>(y, x), dy.at<float>(y, x)); };
  for (int y = 0; y < dx.rows; ++y) {
    for (int x = 0; x < dx.cols; ++x) {
      if (gradientAt(y, x).norm() > first.norm()) first = gradientAt(y, x);
    }
  }
  double second = 0;
  for (int y = 0; y < dx.rows; ++y) {
    for (int x = 0; x < dx.cols; ++x) {
      const Eigen::Vector2d gradient = gradientAt(y, x);
      const bool lies_across = std::abs(gradient.dot(first)) < M_SQRT1_2 * gradient.norm() * first.norm();
      if (lies_across) second = std::max(second, gradient.norm());
    }
  }
  return {first.norm(), second};
}

// An edge of height h blurred with the deviation s has the slope h / (s sqrt(2 pi)) in its middle. Motion blurs one
// edge of a corner more than the other: the worse one counts.
double blurAt(const cv::Mat& grey, const Eigen::Vector2d& pixel, int half) {
  const cv::Rect window(static_cast<int>(std::lround(pixel.x())) - half,
                        static_cast<int>(std::lround(pixel.y())) - half, 2 * half + 1, 2 * half + 1);
  if ((window & cv::Rect(0, 0, grey.cols, grey.rows)) != window) return -1;
  cv::Mat values, dx, dy;
  cv::GaussianBlur(grey(window), values, {0, 0}, 0.7);
  double darkest = 0, brightest = 0;
  cv::minMaxLoc(values, &darkest, &brightest);
  cv::Sobel(values, dx, CV_32F, 1, 0, 3, 1.0 / 8);
  cv::Sobel(values, dy, CV_32F, 0, 1, 3, 1.0 / 8);
  const std::array<double, 2> slopes = slopesOfEdges(dx, dy);
  if (slopes[1] <= 0) return -1;
  const double seen = (brightest - darkest) / (slopes[1] * std::sqrt(2 * CV_PI));
  constexpr double own = 0.7 * 0.7 + 0.5;  // variance that the smoothing and Sobel's differences add
  return std::sqrt(std::max(0.0, seen * seen - own));
}

double medianBlur(const cv::Mat& grey, const std::vector<BoardCorner>& corners, double square_px) {
  const int half = std::clamp(static_cast<int>(square_px * 0.3), 3, 12);
  std::vector<double> blurs;
  for (const BoardCorner& corner : corners) {
    const double blur = blurAt(grey, corner.pixel, half);
    if (blur >= 0) blurs.push_back(blur);
  }
  return medianOr(0.0, std::move(blurs));
}

}  // namespace

std::optional<BoardSighting> detectBoard(const cv::Mat& grey, const Board& board) {
  const FoundCorners found = board.kind == BoardKind::chessboard ? findChessboard(grey, board)
                             : board.kind == BoardKind::charuco  ? findCharuco(grey, board)
                                                                 : findAprilGrid(grey, board);
  if (found.numbers.size() < fewest_corners) return std::nullopt;
  BoardSighting sighting;
  for (std::size_t i = 0; i < found.numbers.size(); ++i) {
    sighting.corners.push_back({found.numbers[i], {found.pixels[i].x, found.pixels[i].y}});
  }
  std::sort(sighting.corners.begin(), sighting.corners.end(),
            [](const BoardCorner& a, const BoardCorner& b) { return a.number < b.number; });
  sighting.square_px = meanSquare(sighting.corners, board);
  sighting.blur_px = medianBlur(grey, sighting.corners, sighting.square_px);
  return sighting;
}

cv::Size chessboardSeen(const cv::Mat& grey) {
  cv::Mat pixels, meta;
  if (!cv::findChessboardCornersSB(grey, {3, 3}, pixels, cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_LARGER, meta)) {
    return {};
  }
  return {std::max(meta.cols, meta.rows), std::min(meta.cols, meta.rows)};
}

namespace {

// What markers there are besides those of the board, with the width of their border; otherwise empty.
std::string otherMarkersSeen(const cv::Mat& grey, const Board& board) {
  for (const MarkerFamily family : {MarkerFamily::apriltag_36h11, MarkerFamily::aruco_4x4, MarkerFamily::aruco_5x5,
                                    MarkerFamily::aruco_6x6, MarkerFamily::aruco_7x7}) {
    for (const int border : {1, 2}) {
      const bool expected = markerCount(board) > 0 && family == markerFamily(board) && border == markerBorder(board);
      std::vector<DetectedMarker> markers = detectMarkers(grey, family, border);
      markers.erase(std::remove_if(markers.begin(), markers.end(),
                                   [&](const DetectedMarker& m) { return expected && m.number < markerCount(board); }),
                    markers.end());
      if (markers.size() < 4) continue;
      int largest = 0;
      for (const DetectedMarker& marker : markers) largest = std::max(largest, marker.number);
      const bool is_apriltag = family == MarkerFamily::apriltag_36h11;
      std::string name =
          is_apriltag ? "AprilTags 36h11" : "ArUco markers of " + std::to_string(markerCells(family, 0).rows);
      if (!is_apriltag) name += " x " + std::to_string(markerCells(family, 0).rows) + " cells";
      return name + " up to number " + std::to_string(largest) + ", black border " + std::to_string(border) +
             (border == 1 ? " cell" : " cells") + " wide";
    }
  }
  return "";
}

}  // namespace

std::string otherBoardSeen(const cv::Mat& grey, const Board& board) {
  const std::string markers = markersCanBeFound() ? otherMarkersSeen(grey, board) : "";
  if (!markers.empty()) return markers;
  const cv::Size seen = chessboardSeen(grey);
  if (seen.empty()) return "";
  const bool same = board.kind == BoardKind::chessboard && seen.width == std::max(board.columns, board.rows) &&
                    seen.height == std::min(board.columns, board.rows);
  if (same) return "";
  return "a chessboard of " + std::to_string(seen.width) + " x " + std::to_string(seen.height) + " inner corners";
}

}  // namespace edgeslam
