#include "places/edge_signature.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <set>

#include "image/hidden_part.h"

namespace edgeslam {
namespace {

constexpr int parts_across = 4;
constexpr double slow_sigma = 5;            // of changes of brightness that do not count [px of the thumbnail]
constexpr double least_seen_share = 0.1;    // of a part that is compared
constexpr double plain_mean_square = 0.01;  // mean square of a thumbnail that shows nothing [grey^2]

// Sums over the edge points: what cv::HuMoments takes, of points instead of pixels, so that sub-pixel places count.
cv::Moments edgeMoments(const EdgeMap& edges) {
  double m00 = 0, m10 = 0, m01 = 0;
  for (const EdgePoint& point : edges.points) {
    m00 += 1;
    m10 += point.pixel.x();
    m01 += point.pixel.y();
  }
  if (m00 == 0) return {};
  // About the centroid from the start: raw third moments of pixels lose half of their digits. In moments about the
  // centroid the central ones are the raw ones.
  double m20 = 0, m11 = 0, m02 = 0, m30 = 0, m21 = 0, m12 = 0, m03 = 0;
  for (const EdgePoint& point : edges.points) {
    const double x = point.pixel.x() - m10 / m00, y = point.pixel.y() - m01 / m00;
    m20 += x * x;
    m11 += x * y;
    m02 += y * y;
    m30 += x * x * x;
    m21 += x * x * y;
    m12 += x * y * y;
    m03 += y * y * y;
  }
  return {m00, 0, 0, m20, m11, m02, m30, m21, m12, m03};
}

std::array<double, 7> huInvariants(const EdgeMap& edges) {
  std::array<double, 7> invariants{};
  if (edges.points.empty()) return invariants;
  cv::Moments moments = edgeMoments(edges);
  // Edges are curves: scaled by s they have s times as many points, not s^2. So that the invariants do not change, they
  // are normalised by the length's powers, m00^(p + q + 1), where an area's go by m00^((p + q) / 2 + 1).
  const double second = std::pow(moments.m00, 3), third = std::pow(moments.m00, 4);
  moments.nu20 = moments.mu20 / second;
  moments.nu11 = moments.mu11 / second;
  moments.nu02 = moments.mu02 / second;
  moments.nu30 = moments.mu30 / third;
  moments.nu21 = moments.mu21 / third;
  moments.nu12 = moments.mu12 / third;
  moments.nu03 = moments.mu03 / third;
  cv::HuMoments(moments, invariants.data());
  return invariants;
}

int partOf(double x, double y, const cv::Size& size) {
  const auto cell = [](double at, int length) {
    return std::clamp(static_cast<int>((at + 0.5) * parts_across / length), 0, parts_across - 1);
  };
  return cell(y, size.height) * parts_across + cell(x, size.width);
}

std::array<EdgeSignaturePart, signature_parts> describeParts(const cv::Mat& grey, const EdgeMap& edges,
                                                             const CameraMask* mask) {
  std::array<EdgeSignaturePart, signature_parts> parts;
  std::array<std::set<int>, signature_parts> chains;
  for (const EdgePoint& point : edges.points) {
    const auto part = static_cast<std::size_t>(partOf(point.pixel.x(), point.pixel.y(), grey.size()));
    parts[part].density += 1;
    chains[part].insert(point.chain);
  }
  cv::Mat seen;  // empty: all of it
  if (mask) seen = mask->hidden == 0;
  cv::Scalar mean, deviation;
  cv::meanStdDev(grey, mean, deviation, seen);
  for (int i = 0; i < signature_parts; ++i) {
    const int row = i / parts_across, column = i % parts_across;
    const cv::Range rows(grey.rows * row / parts_across, grey.rows * (row + 1) / parts_across);
    const cv::Range columns(grey.cols * column / parts_across, grey.cols * (column + 1) / parts_across);
    EdgeSignaturePart& part = parts[static_cast<std::size_t>(i)];
    part.edges = static_cast<double>(chains[static_cast<std::size_t>(i)].size());
    part.density /= std::max(1, rows.size() * columns.size());
    const cv::Mat seen_of_part = seen.empty() ? seen : seen(rows, columns);
    part.is_seen = seen.empty() || cv::mean(seen_of_part)[0] > least_seen_share * 255;
    part.grey = (cv::mean(grey(rows, columns), seen_of_part)[0] - mean[0]) / std::max(1.0, deviation[0]);
  }
  return parts;
}

// Small, blurred, and with the slow changes of brightness taken out, so that exposure and vignetting do not count.
cv::Mat makeThumbnail(const cv::Mat& grey, const CameraMask* mask) {
  const cv::Size size(signature_thumbnail_width, signature_thumbnail_height);
  cv::Mat small, real, slow, fine;
  cv::resize(grey, small, size, 0, 0, cv::INTER_AREA);
  small.convertTo(real, CV_32F);
  const cv::Mat hidden = mask ? hiddenPart(mask->hidden, size) : cv::Mat();
  if (mask) fillHidden(hidden, slow_sigma, real);
  cv::GaussianBlur(real, fine, cv::Size(), 0.7);
  cv::GaussianBlur(real, slow, cv::Size(), slow_sigma);
  fine -= slow;
  if (mask) fine.setTo(0, hidden);
  return fine;
}

double standardDeviation(const EdgeSignature& signature, double EdgeSignaturePart::*value) {
  double sum = 0, squares = 0;
  for (const EdgeSignaturePart& part : signature.parts) {
    sum += part.*value;
    squares += part.*value * (part.*value);
  }
  const double mean = sum / signature_parts;
  return std::sqrt(std::max(0.0, squares / signature_parts - mean * mean));
}

// How alike two values are, in [0, 1], seen against how much the value varies over the parts.
double likeness(double a, double b, double variation) {
  const double difference = std::abs(a - b);
  if (difference == 0) return 1;
  return variation > 0 ? std::exp(-difference / variation) : 0;
}

}  // namespace

EdgeSignature edgeSignature(const cv::Mat& grey, const EdgeMap& edges, const CameraMask* mask) {
  EdgeSignature signature;
  signature.moments = huInvariants(edges);
  signature.parts = describeParts(grey, edges, mask);
  signature.thumbnail = makeThumbnail(grey, mask);
  return signature;
}

double momentScore(const EdgeSignature& a, const EdgeSignature& b, const SignatureOptions& options) {
  double sum = 0;
  for (std::size_t i = 0; i < a.moments.size(); ++i) {
    if (a.moments[i] == b.moments[i]) {
      sum += 1;
    } else if (a.moments[i] * b.moments[i] > 0) {
      sum += std::exp(-std::abs(std::log10(a.moments[i] / b.moments[i])) / options.moment_tolerance);
    }
  }
  return sum / static_cast<double>(a.moments.size());
}

double partVote(const EdgeSignature& a, const EdgeSignature& b, const SignatureOptions& options) {
  constexpr std::array<double EdgeSignaturePart::*, 3> values{&EdgeSignaturePart::edges, &EdgeSignaturePart::density,
                                                              &EdgeSignaturePart::grey};
  // Each value's spread over the parts, against its usual size so that the three can be compared.
  std::array<double, 3> variation{}, weight{};
  for (std::size_t v = 0; v < values.size(); ++v) {
    variation[v] = 0.5 * (standardDeviation(a, values[v]) + standardDeviation(b, values[v]));
    double size = 0;
    for (std::size_t i = 0; i < signature_parts; ++i) {
      size += (std::abs(a.parts[i].*values[v]) + std::abs(b.parts[i].*values[v])) / (2 * signature_parts);
    }
    weight[v] = size > 0 ? variation[v] / size : 0;
  }
  const double total = weight[0] + weight[1] + weight[2];
  if (total <= 0) return a.parts[0].edges == b.parts[0].edges && a.parts[0].density == b.parts[0].density ? 1 : 0;
  int matched = 0, seen = 0;
  for (std::size_t i = 0; i < signature_parts; ++i) {
    if (!a.parts[i].is_seen || !b.parts[i].is_seen) continue;
    ++seen;
    double similarity = 0;
    for (std::size_t v = 0; v < values.size(); ++v) {
      similarity += weight[v] / total * likeness(a.parts[i].*values[v], b.parts[i].*values[v], variation[v]);
    }
    if (similarity > options.part_similarity) ++matched;
  }
  return seen > 0 ? static_cast<double>(matched) / seen : 0;
}

double signatureScore(const EdgeSignature& a, const EdgeSignature& b, const SignatureOptions& options) {
  return 0.5 * (momentScore(a, b, options) + partVote(a, b, options));
}

double thumbnailScore(const EdgeSignature& a, const EdgeSignature& b, int largest_shift) {
  double best = -1;
  for (int y = -largest_shift; y <= largest_shift; ++y) {
    for (int x = -largest_shift; x <= largest_shift; ++x) {
      const cv::Size overlap(signature_thumbnail_width - std::abs(x), signature_thumbnail_height - std::abs(y));
      const cv::Mat of_a = a.thumbnail(cv::Rect(cv::Point(std::max(0, x), std::max(0, y)), overlap));
      const cv::Mat of_b = b.thumbnail(cv::Rect(cv::Point(std::max(0, -x), std::max(0, -y)), overlap));
      const double energy_a = of_a.dot(of_a), energy_b = of_b.dot(of_b);
      if (std::min(energy_a, energy_b) < plain_mean_square * overlap.area()) continue;
      best = std::max(best, of_a.dot(of_b) / std::sqrt(energy_a * energy_b));
    }
  }
  return best == -1 ? 0 : best;
}

}  // namespace edgeslam
