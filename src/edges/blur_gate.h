// P4: a blurred, defocused or covered image is told by what its edges look like, against a threshold that adapts to
// what the scene gave before. The paper takes the variance of the grey values at the edge points. That says more about
// which things are in view than about blur: over eight sequences, wherever it caught shaken frames it also rejected
// sharp ones at which the camera turned to a barer wall. What blur does take from an image is edges and their
// steepness, both at once.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

#include "edges/edge_detection.h"

namespace edgeslam {

struct BlurGateOptions {
  double share_of_average = 0.45;    // a frame whose sharpness falls below this share of the running average is blurred
  double forgetting = 0.85;          // weight of the past in the running average, a frame
  double longest_rejection_s = 0.4;  // since the first rejected frame in a row: then the average starts anew [s]
};

struct BlurGate {
  double average = 0;  // running average of the sharpness of the accepted frames; 0 before the first one
  std::int64_t rejected_since_ns = -1;  // -1: the last frame was accepted
};

struct FrameSharpness {
  std::int64_t time_ns = 0;
  double value = 0;  // see sharpness()
};

// What an image is judged by: the gradients of its edge points, summed, over the number of the image's pixels
// [grey/px]. 0 for an image without edges.
double sharpness(const cv::Mat& grey, const EdgeMap& edges);

// True where the image is to be discarded; updates the gate. An image without edges always is; the first one with
// edges, and the first after the longest rejection, never is: what stays is no blur, but another scene.
bool isBlurred(BlurGate& gate, const FrameSharpness& frame, const BlurGateOptions& options);

}  // namespace edgeslam
