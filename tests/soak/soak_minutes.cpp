#include "soak/soak_minutes.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
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
  std::map<std::string, std::map<std::int64_t, SequencePass>> sequences;
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
    const SequencePass &first = passes.begin()->second, &final = passes.rbegin()->second;
    const double processor_before = first.processor_ms / first.minutes, processor = final.processor_ms / final.minutes;
    const double latency_before = first.latency_ms / first.minutes, latency = final.latency_ms / final.minutes;
    if (processor > most_processor_growth * processor_before) {
      problems.push_back(growth(name + ": processor time a frame [ms]", processor_before, processor));
    }
    if (latency > most_latency_growth * latency_before) {
      problems.push_back(growth(name + ": median latency [ms]", latency_before, latency));
    }
  }
  return problems;
}

}  // namespace edgeslam
