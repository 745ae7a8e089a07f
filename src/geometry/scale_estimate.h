// The scale from many measurements of it, some of them wrong: the robust mean of their logarithms.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace edgeslam {

struct ScaleMeasurement {
  double log_scale = 0;  // natural logarithm of metres a map unit
  double variance = 0;   // of it, over 0
};

struct ScaleEstimate {
  double log_scale = 0;
  double sigma = 0;     // standard deviation of it, that is of the scale over the scale
  std::string problem;  // why this is no scale to go by; sigma is then how far the measurements scatter. Or empty
};

// Errors that single measurements do not share average out, as far as their scatter bears their variances out;
// `shared_sigma` (standard deviation, share of the scale) does not. Of `independent` false nothing averages out: each
// measurement is made of much the same data. Measurements that the others contradict are left out; where these are
// over a third, it is no scale to go by. None where there are fewer than `fewest` (1 or more).
std::optional<ScaleEstimate> scaleEstimate(const std::vector<ScaleMeasurement>& measurements, std::size_t fewest,
                                           double shared_sigma, bool independent);

}  // namespace edgeslam
