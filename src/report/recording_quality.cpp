#include "report/recording_quality.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "files/format_text.h"
#include "geometry/median.h"

namespace edgeslam {
namespace {

struct Problem {
  double severity = 0;  // 0 at its limit, 1 where the recording can hardly be used
  std::string text;
};

double severityOf(double value, double limit, double hardly_usable) {
  return (value - limit) / (hardly_usable - limit);
}

std::optional<Problem> measurementErrors(const RunResult& result) {
  constexpr double limit = 2, most_that_is_measured = 4;
  std::vector<double> factors;
  for (const FrameRecord& frame : result.frames) {
    if (frame.has_pose) factors.push_back(frame.noise_factor);
  }
  const double factor = medianOr(1.0, std::move(factors));
  if (!(factor > limit)) return std::nullopt;
  return Problem{severityOf(factor, limit, most_that_is_measured),
                 formatted("measurements err %.1f times as far as a good camera's: ", factor) +
                     (result.camera.readout_s == 0
                          ? "check the calibration, or the camera has a rolling shutter (docs/calibrating.md)"
                          : "check the calibration (docs/calibrating.md)")};
}

bool isBlurred(const std::string& reason) { return reason.find("blurred image") != std::string::npos; }

std::optional<Problem> blurredFrames(const RunResult& result) {
  constexpr double limit = 0.05, hardly_usable = 0.5;
  const auto blurred = std::count_if(result.frames.begin(), result.frames.end(),
                                     [](const FrameRecord& frame) { return isBlurred(frame.reason); });
  const double share =
      static_cast<double>(blurred) / static_cast<double>(std::max<std::size_t>(1, result.frames.size()));
  if (!(share > limit)) return std::nullopt;
  return Problem{
      severityOf(share, limit, hardly_usable),
      formatted("%.0f %% of the frames are blurred: a shorter exposure helps (docs/mounting.md)", 100 * share)};
}

std::optional<Problem> gapsInTime(const RunResult& result) {
  constexpr double limit = 0.01, hardly_usable = 0.1, longest_usual = 2.5;  // shares of the intervals; median intervals
  std::vector<double> intervals;
  for (std::size_t i = 1; i < result.frames.size(); ++i) {
    intervals.push_back(1e-9 * static_cast<double>(result.frames[i].time_ns - result.frames[i - 1].time_ns));
  }
  if (intervals.empty() || result.dropped_frames > 0) return std::nullopt;
  const double usual = medianOr(0.0, intervals);
  const auto gaps = std::count_if(intervals.begin(), intervals.end(),
                                  [&](double interval) { return interval > longest_usual * usual; });
  const double share = static_cast<double>(gaps) / static_cast<double>(intervals.size());
  if (!(share > limit)) return std::nullopt;
  const double longest = *std::max_element(intervals.begin(), intervals.end());
  return Problem{severityOf(share, limit, hardly_usable),
                 formatted("frames are missing in %.0f places", static_cast<double>(gaps)) +
                     formatted(", the longest gap is %.2g s: ", longest) +
                     "look at the camera's cable and at how it was recorded"};
}

}  // namespace

std::string recordingQuality(const RunResult& result) {
  std::vector<Problem> problems;
  for (const auto& problem : {measurementErrors(result), blurredFrames(result), gapsInTime(result)}) {
    if (problem) problems.push_back(*problem);
  }
  std::stable_sort(problems.begin(), problems.end(),
                   [](const Problem& a, const Problem& b) { return a.severity > b.severity; });
  std::string line;
  for (const Problem& problem : problems) line += (line.empty() ? "" : "; ") + problem.text;
  return line;
}

}  // namespace edgeslam
