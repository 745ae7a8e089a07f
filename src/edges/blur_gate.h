// P4: a blurred or defocused image is told by the variance of the grey values at its edge points, against a threshold that
// adapts to what the scene gave before.
#pragma once

#include <opencv2/core/mat.hpp>

#include "edges/edge_detection.h"

namespace edgeslam {

struct BlurGateOptions {
  double share_of_average = 0.4;  // a frame whose sharpness falls below this share of the running average is blurred
  double forgetting = 0.95;       // weight of the past in the running average, a frame
  int longest_rejection = 15;     // after so many rejected frames in a row the average starts anew [frames]
};

struct BlurGate {
  double average = 0;  // running average of the sharpness; 0 before the first frame
  int rejected_in_a_row = 0;
};

// What P4 judges an image by: variance of the grey values at the edge points, weighted so that an image with few or weak
// edges counts as little. 0 for an image without edges.
double sharpness(const cv::Mat& grey, const EdgeMap& edges);

// True where the image is to be discarded; updates the gate.
bool isBlurred(BlurGate& gate, double frame_sharpness, const BlurGateOptions& options);

}  // namespace edgeslam
