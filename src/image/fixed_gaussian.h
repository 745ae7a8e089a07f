// P1: the weights of a Gaussian blur in fixed point, so that edges are the same on every processor.
#pragma once

#include <cstdint>
#include <vector>

namespace edgeslam {

constexpr int weight_bits = 16;  // all weights of a kernel, both sides, sum up to 1 << weight_bits

// weights[k] is that of the pixels k away from the centre; {1 << weight_bits} is no blur at all.
struct FixedGaussian {
  std::vector<int32_t> weights;

  // For sums of products of 16 bits in pairs: two neighbouring weights in each, the first one in the lower half. What
  // does not fit 16 bits with its sign, the weight of the centre of a narrow Gaussian, is less by 1 << 16.
  std::vector<int32_t> pairs_from_centre;  // (0, 1), (2, 3) ... up to the radius
  std::vector<int32_t> pairs_across;       // (-radius, 1 - radius) ... (radius, nothing)
  std::vector<int32_t> pairs_one_further;  // (nothing, -radius) ... (radius - 1, radius)
  bool centre_is_less = false;

  int radius() const { return static_cast<int>(weights.size()) - 1; }  // [px]
};

// The Gaussian of standard deviation `sigma` >= 0 [px], cut off where it falls below 1.5 % of its height. What rounding
// takes from one weight the next one nearer to the centre is given.
FixedGaussian fixedGaussian(double sigma);

}  // namespace edgeslam
