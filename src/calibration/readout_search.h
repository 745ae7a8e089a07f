// The readout of a rolling shutter, found by what fits best: a recording is run over with several readouts, and the one
// with which the map's points are seen nearest to where they are expected is the camera's.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace edgeslam {

// A run with one readout: how far the map's points were off in each frame [any unit]; 0: the frame says nothing.
struct ReadoutTrial {
  double readout_s = 0;
  std::vector<double> errors;
};

struct ReadoutEstimate {
  std::string problem;  // why the recording does not say; empty where it does
  double readout_s = 0;
  double sigma_s = 0;       // standard deviation
  double error_global = 0;  // geometric mean of the errors with a global shutter ...
  double error_best = 0;    // ... and with the best readout tried, in the trials' unit
};

// Runs over the recording with each of the readouts; the same frames, and the trials in the same order.
using TryReadouts = std::function<std::vector<ReadoutTrial>(const std::vector<double>& readouts_s)>;

// Tries readouts up to `longest_s` of either sign, 10 ms apart, and then 2 ms apart around the best. Stretches of the
// recording have a best readout each: their scatter tells how well the readout is known.
ReadoutEstimate searchReadout(double longest_s, const TryReadouts& tryReadouts);

}  // namespace edgeslam
