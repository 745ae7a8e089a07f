// The files of a run made by hand (unit/report/made_run.h), in a folder as replay leaves it.
#pragma once

#include <nlohmann/json.hpp>

#include "report/run_files.h"
#include "report/run_summary.h"
#include "unit/files/temporary_folder.h"
#include "unit/report/made_run.h"

namespace edgeslam {

inline RunDescription describeRunOver(const std::string& input) {
  RunDescription description = describeMadeRun();
  description.input = input;
  description.sequence = std::filesystem::path(input).filename().string();
  return description;
}

// Returns the folder.
inline std::string writeMadeRun(const TemporaryFolder& folder, const std::string& name, const RunResult& run,
                                const RunDescription& description = describeMadeRun(),
                                const std::optional<Trajectory>& truth = madeGroundTruth()) {
  writeRunFiles(folder.path(name), run, description, truth);
  return folder.path(name);
}

inline nlohmann::json summaryIn(const std::string& folder) {
  return nlohmann::json::parse(fileContent(folder + "/summary.json"));
}

// Writes the run's summary anew, changed by `change`.
template <typename Change>
void changeSummary(const std::string& folder, const Change& change) {
  nlohmann::json summary = summaryIn(folder);
  change(summary);
  std::ofstream(folder + "/summary.json") << summary.dump();
}

// The data in a page.
inline nlohmann::json dataIn(const std::string& page) {
  const std::string open = R"(<script type="application/json" id="data">)";
  const std::size_t begin = page.find(open);
  if (begin == std::string::npos) return {};
  const std::size_t end = page.find("</script>", begin);
  return nlohmann::json::parse(page.substr(begin + open.size(), end - begin - open.size()));
}

inline std::size_t countOf(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

}  // namespace edgeslam
