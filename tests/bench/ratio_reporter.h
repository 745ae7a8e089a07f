// Prints, besides what Google Benchmark does, how many times as long each variant of a kernel took as ours.
#pragma once

#include <benchmark/benchmark.h>

#include <map>
#include <string>
#include <vector>

namespace edgeslam {

// Benchmarks are named KERNEL/VARIANT; the variant "ours" is what the others are compared with. Of repetitions the
// shortest counts.
class RatioReporter : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override;
  void Finalize() override;

 private:
  std::map<std::string, std::map<std::string, double>> shortest_ns_;  // by kernel and variant
};

}  // namespace edgeslam
