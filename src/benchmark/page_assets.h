// The parts of the benchmark's pages that are the same for every run, embedded at build time. Style and charts are
// those of report.html (report/report_assets.h).
#pragma once

#include <string_view>

namespace edgeslam {

struct PageAssets {
  std::string_view comparison_page, comparison_script;  // two runs side by side
  std::string_view set_page, set_script;                // a set of sequences
  std::string_view style, tables;                       // of both
};

PageAssets pageAssets();

}  // namespace edgeslam
