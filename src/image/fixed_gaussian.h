// P1: the weights of a Gaussian blur in fixed point, so that edges are the same on every processor.
#pragma once

#include <cstdint>
#include <vector>

namespace edgeslam {

constexpr int kWeightBits = 16;  // all weights of a kernel, both sides, sum up to 1 << kWeightBits

// weights[k] is that of the pixels k away from the centre; {1 << kWeightBits} is no blur at all.
struct FixedGaussian {
  std::vector<int32_t> weights;

  int radius() const { return static_cast<int>(weights.size()) - 1; }  // [px]
};

// Of standard deviation `sigma` >= 0 [px], cut off where it falls below 1.5 % of its height. What rounding takes from
// one weight the next one nearer to the centre is given.
FixedGaussian fixedGaussian(double sigma);

}  // namespace edgeslam
