// How well and in which direction the grey values around a pixel tell where it is.
#include "edges/structure_tensor.h"

#include <gtest/gtest.h>

#include "unit/edges/synthetic_image.h"

namespace edgeslam {
namespace {

// Not so sharp that central differences are skewed.
cv::Mat blurredLine(const cv::Size& size, const Line& line) {
  return renderEdge(
      size, [&](double x, double y) { return line.distance(x, y); }, 60, 180, 1);
}

TEST(StructureTensor, OfARampIsItsSlopeSquared) {
  cv::Mat ramp(41, 41, CV_8U);
  for (int y = 0; y < 41; ++y) {
    for (int x = 0; x < 41; ++x) ramp.at<uint8_t>(y, x) = static_cast<uint8_t>(10 + 3 * x + 2 * y);
  }
  const StructureTensor tensor = structureTensor(ramp, {20, 20}, 15);
  EXPECT_NEAR(tensor.l1, 13, 1e-4);
  EXPECT_NEAR(tensor.l2, 0, 1e-4);
  EXPECT_NEAR(std::abs(tensor.direction.dot(Eigen::Vector2f(3, 2).normalized())), 1, 1e-5);
}

TEST(StructureTensor, DirectionFollowsTheLine) {
  for (double degrees = 0; degrees < 180; degrees += 9) {
    const Line line = lineThrough(40.3, 30.2, degrees);
    const StructureTensor tensor = structureTensor(blurredLine({81, 61}, line), {40.3F, 30.2F}, 15);
    EXPECT_GT(tensor.l1, 100) << degrees;
    EXPECT_LT(tensor.l2, 0.01F * tensor.l1) << degrees;
    EXPECT_GT(std::abs(tensor.direction.cast<double>().dot(line.normal)), std::cos(1.5 * M_PI / 180)) << degrees;
    EXPECT_NEAR(tensor.direction.norm(), 1, 1e-5);
  }
}

TEST(StructureTensor, BothEigenvaluesAreLargeAtACorner) {
  const StructureTensor tensor = structureTensor(renderCheckerboard({80, 80}, 20), {39.5F, 39.5F}, 15);
  EXPECT_GT(tensor.l2, 0.9F * tensor.l1);
  EXPECT_GT(tensor.l2, 100);
}

// A step between columns 20 and 21, whose central differences are at these two.
TEST(StructureTensor, ItsWindowLiesAroundTheNearestPixel) {
  cv::Mat step(41, 41, CV_8U, cv::Scalar(50));
  step.colRange(21, 41).setTo(150);
  for (const float x : {17.0F, 17.4F, 24.0F, 23.5F}) EXPECT_EQ(structureTensor(step, {x, 20}, 5).l1, 0) << x;
  for (const float x : {17.5F, 18.0F, 23.0F, 23.4F}) EXPECT_GT(structureTensor(step, {x, 20}, 5).l1, 0) << x;
  EXPECT_GT(structureTensor(step.t(), {20, 23}, 5).l1, 0);
  EXPECT_EQ(structureTensor(step.t(), {20, 24}, 5).l1, 0);
}

TEST(StructureTensor, IsZeroOffTheImageAndOnFlatGround) {
  const cv::Mat texture = renderTexture({60, 60}, 1);
  for (const Eigen::Vector2f& pixel : {Eigen::Vector2f(-40, 20), Eigen::Vector2f(20, 1e9F),
                                       Eigen::Vector2f(std::nanf(""), 20), Eigen::Vector2f(20, INFINITY)}) {
    EXPECT_EQ(structureTensor(texture, pixel, 15).l1, 0);
  }
  const StructureTensor flat = structureTensor(cv::Mat(60, 60, CV_8U, cv::Scalar(77)), {30, 30}, 15);
  EXPECT_EQ(flat.l1, 0);
  EXPECT_EQ(flat.direction.norm(), 1);
  EXPECT_EQ(structureTensor(cv::Mat(), {0, 0}, 15).l1, 0);
}

}  // namespace
}  // namespace edgeslam
