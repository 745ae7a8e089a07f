#include "report/report.h"

#include <nlohmann/json.hpp>

#include "report/page_template.h"
#include "report/report_assets.h"
#include "report/report_data.h"

namespace edgeslam {

std::string formatReport(const RunResult& result, const RunSummary& summary, const RunDescription& description,
                         const std::optional<Trajectory>& ground_truth) {
  const ReportAssets assets = reportAssets();
  const std::string data = escapedForScript(reportData(result, summary, description, ground_truth));
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
