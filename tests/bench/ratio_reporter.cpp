#include "bench/ratio_reporter.h"

#include <cstdio>

namespace edgeslam {

void RatioReporter::ReportRuns(const std::vector<Run>& runs) {
  ConsoleReporter::ReportRuns(runs);
  for (const Run& run : runs) {
    const std::string& name = run.run_name.function_name;
    const size_t slash = name.find('/');
    if (run.run_type != Run::RT_Iteration || run.iterations == 0 || slash == std::string::npos) continue;
    const double time_ns = 1e9 * run.cpu_accumulated_time / static_cast<double>(run.iterations);
    const auto [entry, is_new] = shortest_ns_[name.substr(0, slash)].emplace(name.substr(slash + 1), time_ns);
    if (!is_new && time_ns < entry->second) entry->second = time_ns;
  }
}

void RatioReporter::Finalize() {
  ConsoleReporter::Finalize();
  std::printf("\n%-28s %10s   others, as a multiple of ours\n", "kernel", "ours [ms]");
  for (const auto& [kernel, variants] : shortest_ns_) {
    const auto ours = variants.find("ours");
    if (ours == variants.end()) continue;
    std::printf("%-28s %10.4f  ", kernel.c_str(), ours->second / 1e6);
    for (const auto& [variant, time_ns] : variants) {
      if (variant != "ours") std::printf("  %s %.3g", variant.c_str(), time_ns / ours->second);
    }
    std::printf("\n");
  }
}

}  // namespace edgeslam
