// What the views taken so far cover, and which are still missing.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "calibration/view_selection.h"

namespace edgeslam {

constexpr int coverage_columns = 8, coverage_rows = 6;

struct ViewCoverage {
  std::array<std::array<int, coverage_columns>, coverage_rows> corners{};  // of boards in each part of the image
  std::array<int, 9> views_in_region{};  // a third of width and height each, row by row: views with a corner there
  int tilted_left = 0, tilted_right = 0, tilted_up = 0, tilted_down = 0;  // views, by 15 degrees or more
  double largest_filled = 0;  // share of the image that the board took where it was nearest
  int views = 0;

  double share() const;  // of the image's parts that have corners
};

ViewCoverage coverageOf(const std::vector<BoardView>& views, cv::Size size);

// What to do next, a sentence each, the most needed first; empty where the views suffice.
std::vector<std::string> missingViews(const ViewCoverage& coverage);

// Why views like these make no calibration, a clause each; empty where they may.
std::vector<std::string> coverageProblems(const ViewCoverage& coverage);

// The image's parts as lines of text: '.' without corners, '+' with some, '#' with many.
std::vector<std::string> coverageMap(const ViewCoverage& coverage);

}  // namespace edgeslam
