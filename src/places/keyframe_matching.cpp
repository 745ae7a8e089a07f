#include "places/keyframe_matching.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>

#include "geometry/angles.h"

namespace edgeslam {
namespace {

// Pyramid levels of ORB whose patches are described: each 1.44 times as large as the one before.
constexpr int descriptor_levels[] = {0, 2, 4};
constexpr float level_scale = 1.2f;
constexpr int patch_side = 31;

// Points to describe: corner-like ones first, then in the order in which they are.
std::vector<int> choose(const PlaceView& view, int most) {
  std::vector<int> chosen(view.points.size());
  std::iota(chosen.begin(), chosen.end(), 0);
  std::stable_partition(chosen.begin(), chosen.end(),
                        [&](int i) { return view.points[static_cast<std::size_t>(i)].corner; });
  if (static_cast<int>(chosen.size()) > most) chosen.resize(static_cast<std::size_t>(most));
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

DescribedPoints describe(const PlaceView& view, int most, double roll) {
  const std::vector<int> chosen = choose(view, most);
  std::vector<Eigen::Vector2f> pixels;
  pixels.reserve(chosen.size());
  for (const int i : chosen)
    pixels.emplace_back(view.points[static_cast<std::size_t>(i)].measurement.pixel.cast<float>());
  DescribedPoints described = describePoints(view.images->pyramid.levels[0], pixels, roll);
  for (int& point : described.points) point = chosen[static_cast<std::size_t>(point)];
  return described;
}

// Smallest distance over all pairs of patch sizes: CV_32S, a row a point of the first.
cv::Mat distances(const DescribedPoints& first, const DescribedPoints& second) {
  cv::Mat least, distance;
  for (const cv::Mat& a : first.descriptors) {
    for (const cv::Mat& b : second.descriptors) {
      cv::batchDistance(a, b, distance, CV_32S, cv::noArray(), cv::NORM_HAMMING);
      if (least.empty()) {
        distance.copyTo(least);
      } else {
        cv::min(least, distance, least);
      }
    }
  }
  return least;
}

int bestOf(const cv::Mat& row) {
  return static_cast<int>(std::min_element(row.begin<int>(), row.end<int>()) - row.begin<int>());
}

// The best match for a row of distances, or -1 where it is not good or not better than those elsewhere. Points around
// the best one share most of its patch and so say nothing against it.
int distinctMatch(const cv::Mat& row, const std::vector<Eigen::Vector2f>& pixels,
                  const KeyframeMatchingOptions& options) {
  const int best = bestOf(row);
  const double distance = row.at<int>(best);
  if (distance > options.largest_distance) return -1;
  const auto radius = static_cast<float>(options.elsewhere);
  for (int j = 0; j < row.cols; ++j) {
    if (distance <= options.ratio * row.at<int>(j)) continue;
    const Eigen::Vector2f apart = pixels[static_cast<std::size_t>(j)] - pixels[static_cast<std::size_t>(best)];
    if (apart.squaredNorm() > radius * radius) return -1;
  }
  return best;
}

}  // namespace

DescribedPoints describePoints(const cv::Mat& grey, const std::vector<Eigen::Vector2f>& pixels, double roll) {
  DescribedPoints described;
  const cv::Ptr<cv::ORB> orb =
      cv::ORB::create(500, level_scale, 8, patch_side / 2 + 1, 0, 2, cv::ORB::HARRIS_SCORE, patch_side);
  const float angle = static_cast<float>(std::fmod(degrees(roll) + 720.0, 360.0));
  for (const int level : descriptor_levels) {
    std::vector<cv::KeyPoint> keypoints;
    keypoints.reserve(pixels.size());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const float size = static_cast<float>(patch_side) * std::pow(level_scale, static_cast<float>(level));
      keypoints.emplace_back(pixels[i].x(), pixels[i].y(), size, angle, 1.0f, level, static_cast<int>(i));
    }
    cv::Mat descriptors;
    orb->compute(grey, keypoints, descriptors);  // leaves out those near the border, the same ones at every level
    if (described.points.empty()) {
      for (const cv::KeyPoint& keypoint : keypoints) {
        described.points.push_back(keypoint.class_id);
        described.pixels.push_back(pixels[static_cast<std::size_t>(keypoint.class_id)]);
      }
    }
    described.descriptors.push_back(descriptors);
  }
  return described;
}

std::vector<std::pair<int, int>> matchDescriptors(const DescribedPoints& first, const DescribedPoints& second,
                                                  const KeyframeMatchingOptions& options) {
  std::vector<std::pair<int, int>> matches;
  if (first.points.empty() || second.points.empty()) return matches;
  const cv::Mat forward = distances(first, second);
  const cv::Mat backward = forward.t();
  const auto radius = static_cast<float>(options.same_place);
  for (int i = 0; i < forward.rows; ++i) {
    const int j = distinctMatch(forward.row(i), second.pixels, options);
    if (j < 0) continue;
    const int back = bestOf(backward.row(j));
    const Eigen::Vector2f apart =
        first.pixels[static_cast<std::size_t>(back)] - first.pixels[static_cast<std::size_t>(i)];
    if (apart.squaredNorm() > radius * radius) continue;
    matches.emplace_back(i, j);
  }
  return matches;
}

std::vector<std::pair<int, int>> matchKeyframes(const PlaceView& first, const PlaceView& second,
                                                const Pose& first_T_second, const KeyframeMatchingOptions& options) {
  if (!first.images || !second.images) return {};
  const Eigen::Matrix3d rotation = first_T_second.rotation.toRotationMatrix();
  const double roll = std::atan2(rotation(1, 0) - rotation(0, 1), rotation(0, 0) + rotation(1, 1));
  const DescribedPoints in_first = describe(first, options.most_points, roll);
  const DescribedPoints in_second = describe(second, options.most_points, 0);
  std::vector<std::pair<int, int>> matches = matchDescriptors(in_first, in_second, options);
  for (auto& [a, b] : matches) {
    a = in_first.points[static_cast<std::size_t>(a)];
    b = in_second.points[static_cast<std::size_t>(b)];
  }
  return matches;
}

}  // namespace edgeslam
