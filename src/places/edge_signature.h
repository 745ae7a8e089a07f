// P23: what a keyframe looks like, told by its edges: Hu's moment invariants up to third order of the whole image's
// edges (Hu 1962), and number of edges, edge pixel density and mean grey value of 16 parts of the image.
#pragma once

#include <array>
#include <opencv2/core/mat.hpp>

#include "edges/edge_detection.h"
#include "geometry/camera_mask.h"

namespace edgeslam {

constexpr int signature_parts = 16;            // 4 x 4, row by row
constexpr int signature_thumbnail_width = 40;  // [px]
constexpr int signature_thumbnail_height = 30;

struct EdgeSignaturePart {
  double edges = 0;     // chains that pass through the part
  double density = 0;   // edge pixels over pixels
  double grey = 0;      // mean grey value, less the image's mean, over the image's standard deviation
  bool is_seen = true;  // more than a tenth of it is not hidden
};

struct EdgeSignature {
  std::array<double, 7> moments{};  // Hu's seven, for curves: the same at any scale, place and turn of the image
  std::array<EdgeSignaturePart, signature_parts> parts;
  // CV_32F, signature_thumbnail_height x signature_thumbnail_width, blurred, local contrast evened out.
  cv::Mat thumbnail;
};

struct SignatureOptions {
  double part_similarity = 0.7;   // a part matches where the weighted mean of its three similarities is over this
  double moment_tolerance = 0.5;  // difference of a moment's logarithm at which its similarity is 1/e
};

// `grey` is CV_8U, `edges` are its edges. An image without edges has moments of 0 and a plain thumbnail. What `mask`
// hides does not count.
EdgeSignature edgeSignature(const cv::Mat& grey, const EdgeMap& edges, const CameraMask* mask = nullptr);

// Similarity of the moments, in [0, 1]: the mean over the seven of exp(-difference of the logarithms / tolerance), 0
// for one whose sign differs.
double momentScore(const EdgeSignature& a, const EdgeSignature& b, const SignatureOptions& options);

// Share of the parts seen that match their counterpart, in [0, 1]. A part's similarity is the weighted mean of those of
// its number of edges, density and grey value; the weights adapt to the two images: what varies most over an image's
// parts tells most.
double partVote(const EdgeSignature& a, const EdgeSignature& b, const SignatureOptions& options);

// The paper's score, in [0, 1]: the mean of the moments' score and the parts' vote.
double signatureScore(const EdgeSignature& a, const EdgeSignature& b, const SignatureOptions& options);

// Normalized cross-correlation of the thumbnails at the best shift of up to `largest_shift` [px] in each direction, in
// [-1, 1]; 0 where a thumbnail is plain.
double thumbnailScore(const EdgeSignature& a, const EdgeSignature& b, int largest_shift);

}  // namespace edgeslam
