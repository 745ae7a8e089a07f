// P4: blurred images are told by their edges, against a threshold that adapts.
#include "edges/blur_gate.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "unit/edges/synthetic_image.h"

namespace edgeslam {
namespace {

double sharpnessOf(const cv::Mat& image) { return sharpness(image, detectEdges(image, {})); }

TEST(Sharpness, FallsWithBlur) {
  const cv::Mat image = renderTexture({320, 240}, 2);
  double sharper = sharpnessOf(image);
  EXPECT_GT(sharper, 0);
  for (const int side : {5, 11, 21, 41}) {
    cv::Mat shaken;
    cv::blur(image, shaken, cv::Size(side, 1));
    const double blurred = sharpnessOf(shaken);
    EXPECT_LT(blurred, sharper) << side;
    sharper = blurred;
  }
  EXPECT_LT(sharper, 0.45 * sharpnessOf(image));
}

TEST(Sharpness, IsTheSameForFewStrongAndManyWeakEdges) {
  const Line line = lineThrough(60, 50, 0);
  const double strong = sharpnessOf(renderLine({121, 101}, line, 60, 180));
  const double weak = sharpnessOf(renderLine({121, 101}, line, 60, 120));
  EXPECT_NEAR(strong, 2 * weak, 0.05 * strong);
}

TEST(Sharpness, IsZeroWithoutEdges) {
  EXPECT_EQ(sharpnessOf(cv::Mat()), 0);
  EXPECT_EQ(sharpnessOf(cv::Mat(50, 50, CV_8U, cv::Scalar(10))), 0);
}

TEST(BlurGate, FirstFrameAndSteadyOnesPass) {
  BlurGate gate;
  for (int frame = 0; frame < 100; ++frame) EXPECT_FALSE(isBlurred(gate, 1 + 0.2 * (frame % 3), {}));
}

TEST(BlurGate, SuddenFallIsRejectedAndTheNextSharpFramePasses) {
  BlurGate gate;
  for (int frame = 0; frame < 50; ++frame) isBlurred(gate, 1, {});
  EXPECT_TRUE(isBlurred(gate, 0.3, {}));
  EXPECT_TRUE(isBlurred(gate, 0.3, {}));
  EXPECT_FALSE(isBlurred(gate, 0.6, {}));
  EXPECT_EQ(gate.rejected_in_a_row, 0);
}

TEST(BlurGate, OneSharperFrameHardlyRaisesTheBar) {
  BlurGate gate;
  for (int frame = 0; frame < 50; ++frame) isBlurred(gate, 1, {});
  EXPECT_FALSE(isBlurred(gate, 2, {}));
  EXPECT_FALSE(isBlurred(gate, 0.6, {}));
}

TEST(BlurGate, FollowsAViewThatGrowsBare) {
  BlurGate gate;
  double value = 1;
  for (int frame = 0; frame < 90; ++frame) {
    EXPECT_FALSE(isBlurred(gate, value, {})) << frame;
    value *= 0.95;
  }
  EXPECT_LT(value, 0.01);
}

TEST(BlurGate, RejectedFramesDoNotLowerTheBar) {
  BlurGate gate;
  isBlurred(gate, 1, {});
  const double average = gate.average;
  isBlurred(gate, 0.1, {});
  EXPECT_EQ(gate.average, average);
}

TEST(BlurGate, AcceptsTheNewSceneAfterTheLongestRejection) {
  BlurGateOptions options;
  options.longest_rejection = 5;
  BlurGate gate;
  isBlurred(gate, 1, options);
  for (int frame = 0; frame < 5; ++frame) EXPECT_TRUE(isBlurred(gate, 0.1, options));
  EXPECT_FALSE(isBlurred(gate, 0.1, options));
  EXPECT_FALSE(isBlurred(gate, 0.09, options));
}

TEST(BlurGate, ImageWithoutEdgesNeverPasses) {
  BlurGate gate;
  for (int frame = 0; frame < 40; ++frame) {
    EXPECT_TRUE(isBlurred(gate, 0, {}));
    EXPECT_TRUE(isBlurred(gate, std::nan(""), {}));
  }
  EXPECT_FALSE(isBlurred(gate, 0.01, {}));
}

TEST(BlurGate, ShareOfZeroLetsAllEdgesPass) {
  BlurGateOptions options;
  options.share_of_average = 0;
  BlurGate gate;
  isBlurred(gate, 1, options);
  EXPECT_FALSE(isBlurred(gate, 1e-9, options));
}

}  // namespace
}  // namespace edgeslam
