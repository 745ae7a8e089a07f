#include "dataset/report.h"

#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "dataset/report_assets.h"
#include "dataset/report_data.h"

namespace edgeslam {
namespace {

std::string escapedForHtml(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

// Within JSON '<' stands only inside strings, where the escape means the same: so nothing can end the script element.
std::string escapedForScript(const std::string& json) {
  std::string result;
  result.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      result += "\\u003c";
    } else {
      result += c;
    }
  }
  return result;
}

// One pass, so that what is put in is never taken for a place to put something.
std::string filledIn(std::string_view page, const std::vector<std::pair<std::string_view, std::string_view>>& parts) {
  std::string result;
  std::size_t position = 0;
  while (position < page.size()) {
    const std::size_t open = page.find("{{", position);
    if (open == std::string_view::npos) break;
    const std::size_t close = page.find("}}", open);
    if (close == std::string_view::npos) break;
    result += page.substr(position, open - position);
    const std::string_view name = page.substr(open + 2, close - open - 2);
    for (const auto& [part, content] : parts) {
      if (part == name) result += content;
    }
    position = close + 2;
  }
  result += page.substr(position);
  return result;
}

}  // namespace

std::string formatReport(const RunResult& result, const RunSummary& summary, const RunDescription& description,
                         const std::optional<Trajectory>& ground_truth) {
  const ReportAssets assets = reportAssets();
  const std::string data = escapedForScript(reportData(result, summary, description, ground_truth)
                                                .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  const std::string title = escapedForHtml(description.sequence);
  return filledIn(assets.page, {{"title", title},
                                {"style", assets.style},
                                {"three", assets.three},
                                {"orbit_controls", assets.orbit_controls},
                                {"data", data},
                                {"charts", assets.charts},
                                {"trajectory", assets.trajectory},
                                {"map", assets.map},
                                {"script", assets.script}});
}

}  // namespace edgeslam
