#include "geometry/scale_estimate.h"

#include <algorithm>
#include <cmath>

#include "geometry/median.h"

namespace edgeslam {
namespace {

constexpr double outlier = 3;  // in robust standard deviations
constexpr double least_inlier_share = 2.0 / 3;
constexpr double normal_over_median = 1.4826;  // standard deviation over median absolute deviation
constexpr double most_sigma = 10;              // of a logarithm: nothing is known

double weightedMedian(const std::vector<ScaleMeasurement>& measurements) {
  std::vector<ScaleMeasurement> sorted = measurements;
  std::sort(sorted.begin(), sorted.end(),
            [](const ScaleMeasurement& a, const ScaleMeasurement& b) { return a.log_scale < b.log_scale; });
  double all = 0, below = 0;
  for (const ScaleMeasurement& measurement : sorted) all += 1 / measurement.variance;
  for (const ScaleMeasurement& measurement : sorted) {
    below += 1 / measurement.variance;
    if (2 * below >= all) return measurement.log_scale;
  }
  return sorted.back().log_scale;
}

struct Inliers {
  double weights = 0, mean = 0, squares = 0;  // squares: of the errors over their standard deviations
  std::size_t count = 0;
};

Inliers inliersAround(const std::vector<ScaleMeasurement>& measurements, double centre, double widening) {
  Inliers inliers;
  const auto forEach = [&](const auto& use) {
    for (const ScaleMeasurement& measurement : measurements) {
      const double error = measurement.log_scale - centre;
      if (error * error <= outlier * outlier * widening * widening * measurement.variance) use(measurement);
    }
  };
  forEach([&](const ScaleMeasurement& measurement) {
    ++inliers.count;
    inliers.weights += 1 / measurement.variance;
    inliers.mean += measurement.log_scale / measurement.variance;
  });
  if (inliers.count == 0) return inliers;
  inliers.mean /= inliers.weights;
  forEach([&](const ScaleMeasurement& measurement) {
    inliers.squares += std::pow(measurement.log_scale - inliers.mean, 2) / measurement.variance;
  });
  return inliers;
}

}  // namespace

std::optional<ScaleEstimate> scaleEstimate(const std::vector<ScaleMeasurement>& measurements, std::size_t fewest,
                                           double shared_sigma, bool independent) {
  if (measurements.size() < std::max<std::size_t>(fewest, 1)) return std::nullopt;
  const double centre = weightedMedian(measurements);
  std::vector<double> deviations, errors;
  for (const ScaleMeasurement& measurement : measurements) {
    deviations.push_back(std::abs(measurement.log_scale - centre));
    errors.push_back(deviations.back() / std::sqrt(measurement.variance));
  }
  const double widening = std::max(1.0, normal_over_median * upperMedian(std::vector<double>(errors)));
  const Inliers inliers = inliersAround(measurements, centre, widening);
  ScaleEstimate estimate;
  const auto all = static_cast<double>(measurements.size());
  if (static_cast<double>(inliers.count) < least_inlier_share * all) {
    estimate.log_scale = centre;
    estimate.problem = "only " + std::to_string(inliers.count) + " of " + std::to_string(measurements.size()) +
                       " measurements of the scale agree";
    std::sort(deviations.begin(), deviations.end());
    const auto most = static_cast<std::size_t>(least_inlier_share * all);
    estimate.sigma = std::min(most_sigma, std::hypot(deviations[std::min(most, deviations.size() - 1)], shared_sigma));
    return estimate;
  }
  const auto count = static_cast<double>(inliers.count);
  // Less 3: of few measurements the scatter is itself known badly (Student's distribution).
  const double scatter = std::max(1.0, inliers.squares / std::max(1.0, count - 3));
  estimate.log_scale = inliers.mean;
  const double variance = scatter / inliers.weights * (independent ? 1 : count);
  estimate.sigma = std::min(most_sigma, std::hypot(std::sqrt(variance), shared_sigma));
  return estimate;
}

}  // namespace edgeslam
