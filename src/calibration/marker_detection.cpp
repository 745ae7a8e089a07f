#include "calibration/marker_detection.h"

#include <algorithm>
#include <memory>
#include <opencv2/core.hpp>

#include "calibration/marker_finder.h"
#include "edgeslam/input_error.h"
#include "plugins/plugin.h"

namespace edgeslam {
namespace {

OpenedPlugin openMarkers() { return openPlugin("libedgeslam_markers.so", make_marker_finder_name); }

std::unique_ptr<MarkerFinder> markerFinder() {
  const OpenedPlugin plugin = openMarkers();
  if (!plugin.function) {
    throw InputError(
        "boards with markers need the package edgeslam-tools, which is to be installed: sudo apt install "
        "./edgeslam-tools_*.deb (" +
        plugin.problem + "); a chessboard does without");
  }
  return std::unique_ptr<MarkerFinder>(reinterpret_cast<MakeMarkerFinderFunction*>(plugin.function)());
}

GreyView viewOf(const cv::Mat& grey) { return {grey.ptr(), grey.cols, grey.rows, grey.step}; }

// OpenCV has the AprilTags upside down, compared with those of their authors and of Kalibr.
bool isUpsideDown(MarkerFamily family) { return family == MarkerFamily::apriltag_36h11; }

Eigen::Vector2d toVector(const std::array<float, 2>& corner) { return {corner[0], corner[1]}; }

}  // namespace

bool markersCanBeFound() { return openMarkers().function != nullptr; }

std::vector<DetectedMarker> detectMarkers(const cv::Mat& grey, MarkerFamily family, int border) {
  const std::vector<FoundQuadrangle> found = markerFinder()->find(viewOf(grey), family, border);
  std::vector<DetectedMarker> markers;
  for (const FoundQuadrangle& quadrangle : found) {
    const auto isTheSame = [&](const FoundQuadrangle& other) { return other.number == quadrangle.number; };
    if (quadrangle.number < 0 || std::count_if(found.begin(), found.end(), isTheSame) > 1) continue;
    DetectedMarker marker;
    marker.number = quadrangle.number;
    for (std::size_t j = 0; j < 4; ++j) {
      marker.corners[j] = toVector(quadrangle.corners[isUpsideDown(family) ? (j + 2) % 4 : j]);
    }
    markers.push_back(marker);
  }
  return markers;
}

std::vector<std::array<Eigen::Vector2d, 4>> darkQuadrangles(const cv::Mat& grey) {
  std::vector<std::array<Eigen::Vector2d, 4>> found;
  for (const FoundQuadrangle& quadrangle : markerFinder()->find(viewOf(grey), MarkerFamily::apriltag_36h11, 2)) {
    found.emplace_back();
    std::transform(quadrangle.corners.begin(), quadrangle.corners.end(), found.back().begin(), toVector);
  }
  return found;
}

cv::Mat markerCells(MarkerFamily family, int number) {
  const MarkerPattern pattern = markerFinder()->pattern(family, number);
  cv::Mat cells(pattern.side, pattern.side, CV_8U);
  std::copy(pattern.cells.begin(), pattern.cells.end(), cells.begin<unsigned char>());
  if (isUpsideDown(family)) cv::flip(cells, cells, -1);
  return cells;
}

}  // namespace edgeslam
