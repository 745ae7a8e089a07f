#include "pipeline/frame_drawing.h"

#include <gtest/gtest.h>

#include <limits>
#include <opencv2/core.hpp>

namespace edgeslam {
namespace {

cv::Mat plainImage() { return cv::Mat(120, 160, CV_8UC1, cv::Scalar(100)); }

DrawnTrack trackAt(float x, float y, bool mapped, bool corner) {
  DrawnTrack track;
  track.pixel = track.keyframe_pixel = Eigen::Vector2f(x, y);
  track.mapped = mapped;
  track.corner = corner;
  return track;
}

// Whether the drawing differs from one without edges and tracks.
cv::Mat changed(const cv::Mat& drawing, const cv::Mat& grey) {
  cv::Mat difference;
  cv::absdiff(drawing, drawFrame(grey, EdgeMap(), {}, ""), difference);
  cv::Mat any(difference.size(), CV_8UC1);
  for (int y = 0; y < difference.rows; ++y) {
    for (int x = 0; x < difference.cols; ++x)
      any.at<unsigned char>(y, x) = cv::norm(difference.at<cv::Vec3b>(y, x)) > 0 ? 255 : 0;
  }
  return any;
}

TEST(FrameDrawing, keepsSizeAndIsInColour) {
  const cv::Mat drawing = drawFrame(plainImage(), EdgeMap(), {}, "frame 1");
  EXPECT_EQ(drawing.size(), plainImage().size());
  EXPECT_EQ(drawing.type(), CV_8UC3);
  EXPECT_TRUE(drawFrame(cv::Mat(), EdgeMap(), {}, "frame 1").empty());
}

TEST(FrameDrawing, mappedTracksAreGreenAndOthersYellow) {
  const cv::Mat drawing =
      drawFrame(plainImage(), EdgeMap(), {trackAt(40, 40, true, false), trackAt(100, 40, false, false)}, "");
  const cv::Vec3b mapped = drawing.at<cv::Vec3b>(40, 40);
  const cv::Vec3b unmapped = drawing.at<cv::Vec3b>(40, 100);
  EXPECT_GT(mapped[1], mapped[2] + 50);
  EXPECT_GT(unmapped[2], 200);
  EXPECT_GT(unmapped[1], unmapped[0] + 50);
}

TEST(FrameDrawing, drawsOnlyAroundTracksAndEdges) {
  EdgeMap edges;
  edges.points.resize(1);
  edges.points[0].pixel = {20, 90};
  edges.points[0].chain = 3;
  const cv::Mat grey = plainImage();
  cv::Mat any = changed(drawFrame(grey, edges, {trackAt(100, 40, true, true)}, ""), grey);
  EXPECT_EQ(any.at<unsigned char>(90, 20), 255);
  EXPECT_GT(cv::countNonZero(any), 8);
  any(cv::Rect(94, 34, 13, 13)).setTo(0);
  any.at<unsigned char>(90, 20) = 0;
  EXPECT_EQ(cv::countNonZero(any), 0);
}

TEST(FrameDrawing, flowLeadsFromTheKeyframe) {
  DrawnTrack track = trackAt(120, 60, true, true);
  track.keyframe_pixel = {60, 60};
  const cv::Mat grey = plainImage();
  const cv::Mat any = changed(drawFrame(grey, EdgeMap(), {track}, ""), grey);
  for (int x = 61; x < 120; ++x) EXPECT_EQ(any.at<unsigned char>(60, x), 255) << x;
  EXPECT_EQ(any.at<unsigned char>(60, 50), 0);
}

TEST(FrameDrawing, whatIsNotFiniteOrFarOutsideIsLeftOut) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  DrawnTrack far = trackAt(50, 50, true, false);
  far.pixel = {1e30F, -1e30F};
  EdgeMap edges;
  edges.points.resize(2);
  edges.points[0].pixel = {nan, 4};
  edges.points[1].pixel = {-5, 500};
  const cv::Mat grey = plainImage();
  EXPECT_EQ(cv::countNonZero(changed(drawFrame(grey, edges, {trackAt(nan, 2, true, true), far}, ""), grey)), 0);
}

}  // namespace
}  // namespace edgeslam
