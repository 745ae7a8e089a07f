// Where square markers are in an image, and what they look like. What finds them (OpenCV's aruco) is in a library of
// its own, loaded where a board has markers, so that a robot needs none of it (folder markers/).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "calibration/board.h"

namespace edgeslam {

struct GreyView {
  const unsigned char* pixels = nullptr;
  int width = 0, height = 0;
  std::size_t stride = 0;  // from row to row [byte]
};

struct FoundQuadrangle {
  int number = -1;                              // of the marker; -1: none is read in it
  std::array<std::array<float, 2>, 4> corners;  // x y [px]; a marker's clockwise from its first, as OpenCV has it
};

struct MarkerPattern {
  int side = 0;                      // [cells]
  std::vector<unsigned char> cells;  // row by row; 1 white, 0 black; as OpenCV has it
};

class MarkerFinder {
 public:
  virtual ~MarkerFinder() = default;

  // `border`: width of the black border in cells.
  virtual std::vector<FoundQuadrangle> find(const GreyView& grey, MarkerFamily family, int border) const = 0;
  virtual MarkerPattern pattern(MarkerFamily family, int number) const = 0;
};

// What the library gives.
extern "C" using MakeMarkerFinderFunction = MarkerFinder * ();
constexpr const char* make_marker_finder_name = "edgeslamMakeMarkerFinder";

}  // namespace edgeslam
