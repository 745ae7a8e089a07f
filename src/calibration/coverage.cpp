#include "calibration/coverage.h"

#include <algorithm>
#include <cmath>

namespace edgeslam {
namespace {

constexpr double tilted_rad = 0.26;    // 15 degrees
constexpr int views_wanted = 20;       // before the guidance is content
constexpr int fewest_views = 10;       // that a calibration is made of
constexpr int fewest_tilted = 3;       // views, whichever way
constexpr double wanted_filled = 0.2;  // share of the image that the board takes once at least
constexpr double least_filled = 0.04;
constexpr std::array<const char*, 9> kRegions{"top left", "top",         "top right", "left",        "middle",
                                              "right",    "bottom left", "bottom",    "bottom right"};

int tilted(const ViewCoverage& c) { return c.tilted_left + c.tilted_right + c.tilted_up + c.tilted_down; }

std::string regionsWithFewerThan(const ViewCoverage& coverage, int views, bool corners_only) {
  std::string names;
  for (std::size_t i = 0; i < kRegions.size(); ++i) {
    const bool is_corner = i == 0 || i == 2 || i == 6 || i == 8;
    if (coverage.views_in_region[i] >= views || (corners_only && !is_corner)) continue;
    names += (names.empty() ? "" : ", ") + std::string(kRegions[i]);
  }
  return names;
}

std::string percent(double share) { return std::to_string(std::lround(100 * share)) + " %"; }

}  // namespace

double ViewCoverage::share() const {
  int covered = 0;
  for (const auto& row : corners)
    covered += static_cast<int>(std::count_if(row.begin(), row.end(), [](int n) { return n > 0; }));
  return static_cast<double>(covered) / (coverage_columns * coverage_rows);
}

ViewCoverage coverageOf(const std::vector<BoardView>& views, cv::Size size) {
  ViewCoverage coverage;
  coverage.views = static_cast<int>(views.size());
  for (const BoardView& view : views) {
    std::array<bool, 9> seen{};
    for (const BoardCorner& corner : view.sighting.corners) {
      const double x = std::clamp(corner.pixel.x() / size.width, 0.0, 0.999);
      const double y = std::clamp(corner.pixel.y() / size.height, 0.0, 0.999);
      ++coverage.corners[static_cast<std::size_t>(y * coverage_rows)][static_cast<std::size_t>(x * coverage_columns)];
      seen[3 * static_cast<std::size_t>(y * 3) + static_cast<std::size_t>(x * 3)] = true;
    }
    for (std::size_t i = 0; i < seen.size(); ++i) coverage.views_in_region[i] += seen[i] ? 1 : 0;
    const Eigen::Vector2d& tilt = view.look.tilt_rad;
    if (std::abs(tilt.x()) >= std::abs(tilt.y())) {
      coverage.tilted_left += tilt.x() <= -tilted_rad ? 1 : 0;
      coverage.tilted_right += tilt.x() >= tilted_rad ? 1 : 0;
    } else {
      coverage.tilted_up += tilt.y() <= -tilted_rad ? 1 : 0;
      coverage.tilted_down += tilt.y() >= tilted_rad ? 1 : 0;
    }
    coverage.largest_filled = std::max(coverage.largest_filled, view.look.filled);
  }
  return coverage;
}

std::vector<std::string> missingViews(const ViewCoverage& coverage) {
  std::vector<std::string> wishes;
  const std::string regions = regionsWithFewerThan(coverage, 2, false);
  if (!regions.empty()) wishes.push_back("show the board in these parts of the image: " + regions);
  std::string tilts;
  const auto wish = [&](int count, const char* way) {
    if (count < 2) tilts += (tilts.empty() ? "" : ", ") + std::string(way);
  };
  wish(coverage.tilted_left, "to the left");
  wish(coverage.tilted_right, "to the right");
  wish(coverage.tilted_up, "up");
  wish(coverage.tilted_down, "down");
  if (!tilts.empty()) wishes.push_back("tilt the board by 20 to 45 degrees, so that it faces " + tilts);
  if (coverage.largest_filled < wanted_filled) {
    wishes.push_back("come nearer: the board takes " + percent(coverage.largest_filled) + " of the image at most, " +
                     percent(wanted_filled) + " is wanted");
  }
  if (coverage.views < views_wanted) {
    wishes.push_back(std::to_string(views_wanted - coverage.views) + " more views");
  }
  return wishes;
}

std::vector<std::string> coverageProblems(const ViewCoverage& coverage) {
  std::vector<std::string> problems;
  if (coverage.views < fewest_views) {
    problems.push_back("there are " + std::to_string(coverage.views) + " usable views, at least " +
                       std::to_string(fewest_views) + " are needed");
    if (coverage.views == 0) return problems;
  }
  if (coverage.largest_filled < least_filled) {
    problems.push_back("the board takes " + percent(coverage.largest_filled) +
                       " of the image at most; come nearer or print a larger one");
  }
  const std::string corners = regionsWithFewerThan(coverage, 1, true);
  if (!corners.empty()) problems.push_back("no view has the board in these parts of the image: " + corners);
  if (tilted(coverage) < fewest_tilted) {
    problems.push_back("the board is frontal in all views but " + std::to_string(tilted(coverage)) +
                       ", which does not determine the focal length; tilt it by 20 to 45 degrees");
  }
  return problems;
}

std::vector<std::string> coverageMap(const ViewCoverage& coverage) {
  constexpr int many = 20;
  std::vector<std::string> lines;
  for (const auto& row : coverage.corners) {
    std::string line;
    for (const int count : row) line += count == 0 ? '.' : count < many ? '+' : '#';
    lines.push_back(line);
  }
  return lines;
}

}  // namespace edgeslam
