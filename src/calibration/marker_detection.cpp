#include "calibration/marker_detection.h"

#include <algorithm>
#include <opencv2/core/version.hpp>

// Markers moved from the contributed module aruco to objdetect, with another interface.
#if CV_VERSION_MAJOR * 100 + CV_VERSION_MINOR >= 407
#include <opencv2/objdetect/aruco_detector.hpp>
#else
#include <opencv2/aruco.hpp>
#endif

namespace edgeslam {
namespace {

// The dictionaries of a size begin alike, so the largest holds all markers.
auto dictionaryOf(MarkerFamily family) {
  const auto name = family == MarkerFamily::aruco_4x4   ? cv::aruco::DICT_4X4_1000
                    : family == MarkerFamily::aruco_5x5 ? cv::aruco::DICT_5X5_1000
                    : family == MarkerFamily::aruco_6x6 ? cv::aruco::DICT_6X6_1000
                    : family == MarkerFamily::aruco_7x7 ? cv::aruco::DICT_7X7_1000
                                                        : cv::aruco::DICT_APRILTAG_36h11;
  return cv::aruco::getPredefinedDictionary(name);
}

using CornersOfMarkers = std::vector<std::vector<cv::Point2f>>;

template <typename Parameters>
void setParameters(Parameters& parameters, int border) {
  parameters.markerBorderBits = border;
  parameters.adaptiveThreshWinSizeMin = 7;
  parameters.adaptiveThreshWinSizeMax = 47;
  parameters.adaptiveThreshWinSizeStep = 10;
  parameters.minMarkerPerimeterRate = 0.02;
  parameters.perspectiveRemovePixelPerCell = 6;
}

#if CV_VERSION_MAJOR * 100 + CV_VERSION_MINOR >= 407
void detect(const cv::Mat& grey, MarkerFamily family, int border, CornersOfMarkers& corners, std::vector<int>& numbers,
            CornersOfMarkers& rejected) {
  cv::aruco::DetectorParameters parameters;
  setParameters(parameters, border);
  cv::aruco::ArucoDetector(dictionaryOf(family), parameters).detectMarkers(grey, corners, numbers, rejected);
}
cv::Mat bytesOf(MarkerFamily family, int number) { return dictionaryOf(family).bytesList.rowRange(number, number + 1); }
int cellsOf(MarkerFamily family) { return dictionaryOf(family).markerSize; }
#else
void detect(const cv::Mat& grey, MarkerFamily family, int border, CornersOfMarkers& corners, std::vector<int>& numbers,
            CornersOfMarkers& rejected) {
  const cv::Ptr<cv::aruco::DetectorParameters> parameters = cv::aruco::DetectorParameters::create();
  setParameters(*parameters, border);
  cv::aruco::detectMarkers(grey, dictionaryOf(family), corners, numbers, parameters, rejected);
}
cv::Mat bytesOf(MarkerFamily family, int number) {
  return dictionaryOf(family)->bytesList.rowRange(number, number + 1);
}
int cellsOf(MarkerFamily family) { return dictionaryOf(family)->markerSize; }
#endif

// OpenCV has the AprilTags upside down, compared with those of their authors and of Kalibr.
bool isUpsideDown(MarkerFamily family) { return family == MarkerFamily::apriltag_36h11; }

}  // namespace

std::vector<DetectedMarker> detectMarkers(const cv::Mat& grey, MarkerFamily family, int border) {
  CornersOfMarkers corners, rejected;
  std::vector<int> numbers;
  detect(grey, family, border, corners, numbers, rejected);
  std::vector<DetectedMarker> markers;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (std::count(numbers.begin(), numbers.end(), numbers[i]) > 1) continue;
    DetectedMarker marker;
    marker.number = numbers[i];
    for (std::size_t j = 0; j < 4; ++j) {
      const cv::Point2f& corner = corners[i][isUpsideDown(family) ? (j + 2) % 4 : j];
      marker.corners[j] = {corner.x, corner.y};
    }
    markers.push_back(marker);
  }
  return markers;
}

std::vector<std::array<Eigen::Vector2d, 4>> darkQuadrangles(const cv::Mat& grey) {
  CornersOfMarkers corners, rejected;
  std::vector<int> numbers;
  detect(grey, MarkerFamily::apriltag_36h11, 2, corners, numbers, rejected);
  corners.insert(corners.end(), rejected.begin(), rejected.end());
  std::vector<std::array<Eigen::Vector2d, 4>> found;
  for (const std::vector<cv::Point2f>& quadrangle : corners) {
    if (quadrangle.size() != 4) continue;
    found.emplace_back();
    for (std::size_t i = 0; i < 4; ++i) found.back()[i] = {quadrangle[i].x, quadrangle[i].y};
  }
  return found;
}

cv::Mat markerCells(MarkerFamily family, int number) {
  cv::Mat cells = cv::aruco::Dictionary::getBitsFromByteList(bytesOf(family, number), cellsOf(family));
  if (isUpsideDown(family)) cv::flip(cells, cells, -1);
  return cells;
}

}  // namespace edgeslam
