// The parts of report.html that are the same for every run, embedded at build time.
#pragma once

#include <string_view>

namespace edgeslam {

struct ReportAssets {
  std::string_view page;  // HTML with a {{name}} for each of the parts below and for the run's data
  std::string_view style;
  std::string_view charts;          // axes, lines, bands over time
  std::string_view trajectory;      // the views from above and from the side
  std::string_view map;             // the 3D map
  std::string_view script;          // what puts the page together
  std::string_view three;           // three.js (MIT)
  std::string_view orbit_controls;  // its mouse control (MIT)
};

ReportAssets reportAssets();

}  // namespace edgeslam
