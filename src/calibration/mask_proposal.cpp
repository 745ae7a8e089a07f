#include "calibration/mask_proposal.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace edgeslam {
namespace {

constexpr int working_width = 640;    // larger images are made smaller [px]
constexpr double smoothing = 2;       // [px]
constexpr double usual_gradient = 3;  // one as steep is shortened to 0.7 [grey/px]
constexpr double edge_square = 0.3;   // squared length from which on there is an edge

constexpr double least_changed_share = 0.25;  // of the edges, from a view to the next

// Of the squared mean of a pixel's directions. A body's edges come to 0.5 to 1; in scenes that pass by, not even the
// horizon comes to more than 0.2.
constexpr double static_square = 0.4;
constexpr double quiet_share = 0.25;    // of the median change: where less changes no edge passes by
constexpr double least_enclosed = 0.9;  // share of a quiet region's outline that static edges have
constexpr int bridged = 2;              // gaps in static edges [px]
constexpr int closed_gap = 12;          // between parts of a body [px]
constexpr int outline = 4;              // what is blurred around a body [px]
constexpr double least_area = 0.0005;   // of the image: less is a speck

cv::Mat squaredLength(const cv::Mat& x, const cv::Mat& y) { return x.mul(x) + y.mul(y); }

cv::Mat disc(int radius) { return cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * radius + 1, 2 * radius + 1}); }

cv::Mat widened(const cv::Mat& region, int radius) {
  cv::Mat wide;
  cv::dilate(region, wide, disc(radius));
  return wide;
}

float medianOf(const cv::Mat& image) {
  std::vector<float> values(image.begin<float>(), image.end<float>());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// The connected parts of `region`, each as an image; without specks.
std::vector<cv::Mat> partsOf(const cv::Mat& region) {
  cv::Mat labels, statistics, centroids;
  const int count = cv::connectedComponentsWithStats(region, labels, statistics, centroids, 8, CV_32S);
  std::vector<cv::Mat> parts;
  for (int label = 1; label < count; ++label) {
    const int area = statistics.at<int>(label, cv::CC_STAT_AREA);
    if (area >= least_area * static_cast<double>(region.total())) parts.emplace_back(labels == label);
  }
  return parts;
}

// The parts of `region` whose outline is that of static edges, or the image's.
cv::Mat enclosedBy(const cv::Mat& edges, const cv::Mat& region) {
  cv::Mat enclosed(region.size(), CV_8U, cv::Scalar(0));
  for (const cv::Mat& part : partsOf(region)) {
    const cv::Mat around = widened(part, 1) & ~part;
    const int length = cv::countNonZero(around), at_edges = cv::countNonZero(around & edges);
    if (at_edges > 0 && at_edges >= least_enclosed * length) enclosed |= part;
  }
  return enclosed;
}

cv::Mat withoutSpecks(const cv::Mat& region) {
  cv::Mat kept(region.size(), CV_8U, cv::Scalar(0));
  for (const cv::Mat& part : partsOf(region)) kept |= part;
  return kept;
}

}  // namespace

EdgeChanges::Directions EdgeChanges::directions(const cv::Mat& grey) {
  cv::Mat small = grey, smooth, x, y, length;
  if (grey.cols > working_width) {
    const int height = std::max(1, cvRound(static_cast<double>(grey.rows) * working_width / grey.cols));
    cv::resize(grey, small, {working_width, height}, 0, 0, cv::INTER_AREA);
  }
  small.convertTo(smooth, CV_32F);
  cv::GaussianBlur(smooth, smooth, {}, smoothing);
  cv::Sobel(smooth, x, CV_32F, 1, 0, 3, 1.0 / 8);
  cv::Sobel(smooth, y, CV_32F, 0, 1, 3, 1.0 / 8);
  cv::sqrt(squaredLength(x, y) + usual_gradient * usual_gradient, length);
  return {x / length, y / length};
}

double EdgeChanges::changedShare(const Directions& a, const Directions& b) {
  const cv::Mat is_edge = (squaredLength(a.x, a.y) > edge_square) | (squaredLength(b.x, b.y) > edge_square);
  const cv::Mat changed = (squaredLength(a.x - b.x, a.y - b.y) > edge_square) & is_edge;
  return static_cast<double>(cv::countNonZero(changed)) / std::max(1, cv::countNonZero(is_edge));
}

void EdgeChanges::add(const cv::Mat& grey) {
  CV_Assert(grey.type() == CV_8U && !grey.empty() && (views_ == 0 || grey.size() == latest_view_.size()));
  Directions now = directions(grey);
  if (views_ > 0 && changedShare(latest_, now) < least_changed_share) return;
  if (views_ == 0) {
    for (cv::Mat* sum : {&sum_.x, &sum_.y, &squares_}) *sum = cv::Mat::zeros(now.x.size(), CV_32F);
  }
  ++views_;
  sum_.x += now.x;
  sum_.y += now.y;
  squares_ += squaredLength(now.x, now.y);
  latest_ = std::move(now);
  grey.copyTo(latest_view_);
}

cv::Mat EdgeChanges::proposeMask() const {
  const cv::Mat constant = squaredLength(sum_.x / views_, sum_.y / views_);
  const cv::Mat change = squares_ / views_ - constant;
  const cv::Mat static_edges = constant > static_square;
  const cv::Mat barrier = widened(static_edges, bridged);
  const cv::Mat quiet = change < quiet_share * static_cast<double>(medianOf(change));
  cv::Mat body = static_edges | enclosedBy(barrier, quiet & ~barrier);
  cv::morphologyEx(body, body, cv::MORPH_CLOSE, disc(closed_gap));
  body = widened(withoutSpecks(body), outline);
  cv::resize(body, body, latest_view_.size(), 0, 0, cv::INTER_NEAREST);
  return ~body;
}

cv::Mat drawMask(const cv::Mat& grey, const cv::Mat& mask) {
  cv::Mat picture, red;
  cv::cvtColor(grey, picture, cv::COLOR_GRAY2BGR);
  cv::addWeighted(picture, 0.5, cv::Mat(picture.size(), CV_8UC3, cv::Scalar(0, 0, 255)), 0.5, 0, red);
  red.copyTo(picture, mask == 0);
  return picture;
}

}  // namespace edgeslam
