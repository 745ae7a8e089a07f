// libedgeslam_markers.so: square markers by OpenCV, and all that its versions do differently there.
#include <opencv2/core/version.hpp>

// Markers moved from the contributed module aruco to objdetect, with another interface.
#if CV_VERSION_MAJOR * 100 + CV_VERSION_MINOR >= 407
#include <opencv2/objdetect/aruco_detector.hpp>
#else
#include <opencv2/aruco.hpp>
#endif

#include "calibration/marker_finder.h"

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

void append(const std::vector<cv::Point2f>& corners, int number, std::vector<FoundQuadrangle>& found) {
  if (corners.size() != 4) return;
  FoundQuadrangle quadrangle;
  quadrangle.number = number;
  for (std::size_t i = 0; i < 4; ++i) quadrangle.corners[i] = {corners[i].x, corners[i].y};
  found.push_back(quadrangle);
}

class OpenCvMarkers : public MarkerFinder {
 public:
  std::vector<FoundQuadrangle> find(const GreyView& view, MarkerFamily family, int border) const override {
    const cv::Mat grey(view.height, view.width, CV_8U, const_cast<unsigned char*>(view.pixels), view.stride);
    CornersOfMarkers corners, rejected;
    std::vector<int> numbers;
    detect(grey, family, border, corners, numbers, rejected);
    std::vector<FoundQuadrangle> found;
    for (std::size_t i = 0; i < numbers.size(); ++i) append(corners[i], numbers[i], found);
    for (const std::vector<cv::Point2f>& other : rejected) append(other, -1, found);
    return found;
  }

  MarkerPattern pattern(MarkerFamily family, int number) const override {
    const int side = cellsOf(family);
    const cv::Mat cells = cv::aruco::Dictionary::getBitsFromByteList(bytesOf(family, number), side);
    MarkerPattern pattern{side, {}};
    for (int row = 0; row < side; ++row)
      pattern.cells.insert(pattern.cells.end(), cells.ptr(row), cells.ptr(row) + side);
    return pattern;
  }
};

}  // namespace

extern "C" __attribute__((visibility("default"))) MarkerFinder* edgeslamMakeMarkerFinder() { return new OpenCvMarkers; }

}  // namespace edgeslam
