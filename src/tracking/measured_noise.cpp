#include "tracking/measured_noise.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "geometry/median.h"

namespace edgeslam {
namespace {

constexpr double quantile = 0.35;
constexpr double quantile_of_normal = 0.4538;  // 35 % of normally distributed values are within so many deviations
constexpr double far_sigmas = 12;
constexpr int fewest_points = 20;
constexpr double largest_ratio = 3;  // that a frame is taken to say

}  // namespace

NoiseEvidence noiseEvidence(const std::pmr::vector<double>& errors_across, std::pmr::memory_resource* memory) {
  NoiseEvidence evidence;
  evidence.points = static_cast<int>(errors_across.size());
  if (errors_across.empty()) return evidence;
  std::pmr::vector<double> errors(memory);
  errors.reserve(errors_across.size());
  for (const double error : errors_across) errors.push_back(std::abs(error));
  const auto near = std::count_if(errors.begin(), errors.end(), [](double error) { return error < far_sigmas; });
  evidence.share_within_12_sigma = static_cast<double>(near) / static_cast<double>(errors.size());
  const auto at = errors.begin() + static_cast<std::ptrdiff_t>(quantile * static_cast<double>(errors.size()));
  std::nth_element(errors.begin(), at, errors.end());
  evidence.ratio = *at / quantile_of_normal;
  return evidence;
}

bool saysSomething(const NoiseEvidence& evidence) {
  return evidence.points >= fewest_points && std::isfinite(evidence.ratio);
}

double MeasuredNoise::observe(const NoiseEvidence& evidence) {
  if (!saysSomething(evidence) || evidence.share_within_12_sigma < options_.least_share_within_12_sigma) return 1;
  const double before = factor_;
  levels_[observed_++ % levels_.size()] = factor_ * std::min(evidence.ratio, largest_ratio);
  auto sorted = levels_;
  const auto told = sorted.begin() + static_cast<std::ptrdiff_t>(std::min(observed_, levels_.size()));
  const auto median = sorted.begin() + (told - sorted.begin()) / 2;
  std::nth_element(sorted.begin(), median, told);
  factor_ = std::clamp(*median, 1.0, std::max(1.0, options_.most));
  return factor_ / before;
}

double noiseFactorOf(const Keyframe& keyframe, const PointAccuracyOptions& presumed) {
  std::vector<double> factors;
  for (const PointObservation& observation : keyframe.observations) {
    factors.push_back(observation.measurement.sigma_normal /
                      (observation.corner ? presumed.sigma_corner : presumed.sigma_edge));
  }
  return factors.empty() ? 1 : std::max(1.0, upperMedian(factors));
}

}  // namespace edgeslam
