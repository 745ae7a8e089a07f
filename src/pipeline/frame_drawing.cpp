#include "pipeline/frame_drawing.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace edgeslam {
namespace {

constexpr int subpixel_bits = 4;  // OpenCV draws at fixed-point coordinates
const cv::Scalar mapped_colour(90, 230, 60);
const cv::Scalar unmapped_colour(40, 210, 255);

cv::Point fixedPoint(const Eigen::Vector2f& pixel) {
  const float unit = 1 << subpixel_bits;
  return {cvRound(pixel.x() * unit), cvRound(pixel.y() * unit)};
}

// A coordinate far outside would overflow the fixed-point numbers and draws nothing anyway.
bool isDrawable(const Eigen::Vector2f& pixel, const cv::Mat& image) {
  const float reach = 4.0F * static_cast<float>(std::max(image.cols, image.rows));
  return pixel.allFinite() && pixel.cwiseAbs().maxCoeff() < reach;
}

// Hues that follow the golden section, so that neighbouring numbers look different.
cv::Vec3f chainColour(int chain) {
  const double turn = std::fmod(chain * 0.618033988749895, 1.0) * 6.0;
  const auto channel = [turn](double offset) {
    const double position = std::fmod(turn + offset, 6.0);
    return static_cast<float>(80.0 + 175.0 * std::clamp(std::abs(position - 3.0) - 1.0, 0.0, 1.0));
  };
  return {channel(2.0), channel(4.0), channel(0.0)};
}

void drawEdges(cv::Mat& image, const EdgeMap& edges) {
  constexpr float opacity = 0.45F;
  for (const EdgePoint& point : edges.points) {
    if (!isDrawable(point.pixel, image)) continue;
    const cv::Point place(cvRound(point.pixel.x()), cvRound(point.pixel.y()));
    if (place.x < 0 || place.y < 0 || place.x >= image.cols || place.y >= image.rows) continue;
    cv::Vec3b& pixel = image.at<cv::Vec3b>(place);
    const cv::Vec3f colour = chainColour(std::max(point.chain, 0));
    for (int c = 0; c < 3; ++c) {
      pixel[c] = cv::saturate_cast<unsigned char>((1 - opacity) * static_cast<float>(pixel[c]) + opacity * colour[c]);
    }
  }
}

void drawTrack(cv::Mat& image, const DrawnTrack& track) {
  const cv::Scalar& colour = track.mapped ? mapped_colour : unmapped_colour;
  const cv::Point place = fixedPoint(track.pixel);
  if (track.corner) {
    const cv::Point reach(2 << subpixel_bits, 2 << subpixel_bits);
    cv::rectangle(image, place - reach, place + reach, colour, 1, cv::LINE_AA, subpixel_bits);
    return;
  }
  cv::circle(image, place, 3 << (subpixel_bits - 1), colour, cv::FILLED, cv::LINE_AA, subpixel_bits);
  if (!track.normal.allFinite()) return;
  const Eigen::Vector2f tick = 4.0F * track.normal.cwiseMax(-1.0F).cwiseMin(1.0F);
  cv::line(image, fixedPoint(track.pixel - tick), fixedPoint(track.pixel + tick), colour, 1, cv::LINE_AA,
           subpixel_bits);
}

void drawCaption(cv::Mat& image, const std::string& caption) {
  if (caption.empty()) return;
  const double size = std::max(0.35, 0.45 * image.cols / 640.0);
  int baseline = 0;
  const cv::Size text = cv::getTextSize(caption, cv::FONT_HERSHEY_SIMPLEX, size, 1, &baseline);
  const int height = std::min(image.rows, text.height + baseline + 8);
  cv::Mat band = image.rowRange(image.rows - height, image.rows);
  band.convertTo(band, -1, 0.35);
  cv::putText(image, caption, {6, image.rows - baseline - 3}, cv::FONT_HERSHEY_SIMPLEX, size, cv::Scalar::all(240), 1,
              cv::LINE_AA);
}

}  // namespace

cv::Mat drawFrame(const cv::Mat& grey, const EdgeMap& edges, const std::vector<DrawnTrack>& tracks,
                  const std::string& caption) {
  if (grey.empty()) return {};
  cv::Mat image;
  cv::cvtColor(grey, image, cv::COLOR_GRAY2BGR);
  image.convertTo(image, -1, 0.75);  // so that colours stand out from bright walls
  drawEdges(image, edges);
  for (const DrawnTrack& track : tracks) {
    if (!isDrawable(track.pixel, image) || !isDrawable(track.keyframe_pixel, image)) continue;
    cv::line(image, fixedPoint(track.keyframe_pixel), fixedPoint(track.pixel),
             0.7 * (track.mapped ? mapped_colour : unmapped_colour), 1, cv::LINE_AA, subpixel_bits);
  }
  for (const DrawnTrack& track : tracks) {
    if (isDrawable(track.pixel, image)) drawTrack(image, track);
  }
  drawCaption(image, caption);
  return image;
}

}  // namespace edgeslam
