#include "inertia/sample_gap_watch.h"

#include <algorithm>
#include <optional>

#include "files/format_text.h"
#include "inertia/inertial_history.h"

namespace edgeslam {
namespace {

constexpr std::int64_t looked_back_ns = 10'000'000'000;

std::optional<SampleGap> gapBetween(std::int64_t from_ns, std::int64_t to_ns) {
  const double seconds = static_cast<double>(to_ns - from_ns) * 1e-9;
  return seconds > InertialHistory::longest_gap_s ? std::optional(SampleGap{to_ns, seconds}) : std::nullopt;
}

template <typename Gaps>
std::string told(const Gaps& gaps, const char* when) {
  if (gaps.empty()) return "";
  double longest_s = 0, all_s = 0;
  for (const SampleGap& gap : gaps) {
    longest_s = std::max(longest_s, gap.seconds);
    all_s += gap.seconds;
  }
  return formatted("samples are missing: %zu %s%s, %.2f s in all, the longest %.2f s; there the camera is alone",
                   gaps.size(), gaps.size() == 1 ? "gap" : "gaps", when, all_s, longest_s);
}

}  // namespace

void SampleGapWatch::add(std::int64_t time_ns) {
  if (time_ns < time_ns_) gaps_.clear();
  const std::optional<SampleGap> gap = time_ns_ < 0 ? std::nullopt : gapBetween(time_ns_, time_ns);
  if (gap) gaps_.push_back(*gap);
  time_ns_ = time_ns;
  while (!gaps_.empty() && time_ns_ - gaps_.front().end_ns > looked_back_ns) gaps_.pop_front();
}

std::string SampleGapWatch::problem() const { return told(gaps_, " in the last 10 s"); }

std::string sampleGapProblem(const std::vector<InertialSample>& samples) {
  std::vector<SampleGap> gaps;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if (const auto gap = gapBetween(samples[i - 1].time_ns, samples[i].time_ns)) gaps.push_back(*gap);
  }
  return told(gaps, "");
}

}  // namespace edgeslam
