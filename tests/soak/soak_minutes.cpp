#include "soak/soak_minutes.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <map>

namespace edgeslam {
namespace {

constexpr double most_memory_growth = 1.08, most_memory_growth_mb = 16;
constexpr std::int64_t fewest_passes_for_memory = 9;
constexpr double most_processor_growth = 1.5, most_latency_growth = 3;

std::string growth(const std::string& what, double from, double to) {
  char text[160];
  std::snprintf(text, sizeof(text), "%s grew from %.2f to %.2f", what.c_str(), from, to);
  return text;
}

// Of one pass over one sequence, the mean over its minutes.
struct SequencePass {
  double processor_ms = 0, latency_ms = 0;
  int minutes = 0;
};
using Passes = std::map<std::int64_t, SequencePass>;

// Of an even number, the lower one.
double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Of the passes from `first` to `final`, or the one nearest to them: a single one tells little, since where the map
// was left by the pass before decides how much there is to do.
SequencePass medianPass(const Passes& passes, std::int64_t first, std::int64_t final) {
  auto begin = passes.lower_bound(first), end = passes.upper_bound(final);
  if (begin == end) {
    if (begin == passes.end()) --begin;
    end = std::next(begin);
  }
  std::vector<double> processor_ms, latency_ms;
  for (auto pass = begin; pass != end; ++pass) {
    processor_ms.push_back(pass->second.processor_ms / pass->second.minutes);
    latency_ms.push_back(pass->second.latency_ms / pass->second.minutes);
  }
  return {median(processor_ms), median(latency_ms), 1};
}

}  // namespace

std::string soakHeading() {
  return "pass,sequence,frames,time_s,wall_s,memory_mb,processor_ms,latency_50_ms,latency_90_ms,latency_99_ms,"
         "good_share,passed_over,mapping_behind,not_published,keyframes,points\n";
}

std::string soakLine(const SoakMinute& m) {
  char text[400];
  std::snprintf(text, sizeof(text), "%lld,%s,%lld,%.1f,%.1f,%.1f,%.3f,%.3f,%.3f,%.3f,%.3f,%lld,%lld,%lld,%zu,%zu\n",
                static_cast<long long>(m.pass), m.sequence.c_str(), static_cast<long long>(m.frames), m.time_s,
                m.wall_s, m.memory_mb, m.processor_ms, m.latency_50_ms, m.latency_90_ms, m.latency_99_ms, m.good_share,
                static_cast<long long>(m.passed_over), static_cast<long long>(m.mapping_behind),
                static_cast<long long>(m.not_published), m.keyframes, m.points);
  return text;
}

double residentMegabytes() {
  std::ifstream file("/proc/self/statm");
  double all = 0, resident = 0;
  file >> all >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

std::vector<std::string> soakProblems(const std::vector<SoakMinute>& minutes) {
  std::vector<std::string> problems;
  if (minutes.empty() || minutes.back().pass < 2) return {"too short to tell: three passes are needed"};
  const std::int64_t last = minutes.back().pass, third = std::max<std::int64_t>(1, last / 3);
  double early_mb = 0, late_mb = 0;
  std::map<std::string, Passes> sequences;
  for (const SoakMinute& minute : minutes) {
    if (minute.pass >= 1 && minute.pass <= third) early_mb = std::max(early_mb, minute.memory_mb);
    if (minute.pass > last - third) late_mb = std::max(late_mb, minute.memory_mb);
    if (minute.pass % 2 == 0) continue;
    SequencePass& pass = sequences[minute.sequence][minute.pass];
    pass.processor_ms += minute.processor_ms;
    pass.latency_ms += minute.latency_50_ms;
    ++pass.minutes;
  }
  if (last >= fewest_passes_for_memory && late_mb > most_memory_growth * early_mb + most_memory_growth_mb) {
    problems.push_back(growth("memory [MB]", early_mb, late_mb));
  }
  for (const auto& [name, passes] : sequences) {
    const SequencePass early = medianPass(passes, 0, third), late = medianPass(passes, last - third + 1, last);
    if (late.processor_ms > most_processor_growth * early.processor_ms) {
      problems.push_back(growth(name + ": processor time a frame [ms]", early.processor_ms, late.processor_ms));
    }
    if (late.latency_ms > most_latency_growth * early.latency_ms) {
      problems.push_back(growth(name + ": median latency [ms]", early.latency_ms, late.latency_ms));
    }
  }
  return problems;
}

}  // namespace edgeslam
