// P4: blurred images are told by their edges, against a threshold that adapts.
#include "edges/blur_gate.h"

#include <gtest/gtest.h>

#include <cmath>
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

// A gate that sees frames at 100 frames/s.
class Gate {
 public:
  explicit Gate(const BlurGateOptions& options = {}) : options_(options) {}

  bool isBlurred(double frame_sharpness) {
    time_ns_ += 10'000'000;
    return edgeslam::isBlurred(gate_, {time_ns_, frame_sharpness}, options_);
  }
  double average() const { return gate_.average; }

 private:
  BlurGateOptions options_;
  BlurGate gate_;
  std::int64_t time_ns_ = 1'000'000'000;
};

TEST(BlurGate, FirstFrameAndSteadyOnesPass) {
  Gate gate;
  for (int frame = 0; frame < 100; ++frame) EXPECT_FALSE(gate.isBlurred(1 + 0.2 * (frame % 3)));
}

TEST(BlurGate, SuddenFallIsRejectedAndTheNextSharpFramePasses) {
  Gate gate;
  for (int frame = 0; frame < 50; ++frame) gate.isBlurred(1);
  EXPECT_TRUE(gate.isBlurred(0.3));
  EXPECT_TRUE(gate.isBlurred(0.3));
  EXPECT_FALSE(gate.isBlurred(0.6));
  EXPECT_TRUE(gate.isBlurred(0.3));
}

TEST(BlurGate, OneSharperFrameHardlyRaisesTheBar) {
  Gate gate;
  for (int frame = 0; frame < 50; ++frame) gate.isBlurred(1);
  EXPECT_FALSE(gate.isBlurred(2));
  EXPECT_FALSE(gate.isBlurred(0.6));
}

TEST(BlurGate, FollowsAViewThatGrowsBare) {
  Gate gate;
  double value = 1;
  for (int frame = 0; frame < 90; ++frame) {
    EXPECT_FALSE(gate.isBlurred(value)) << frame;
    value *= 0.95;
  }
  EXPECT_LT(value, 0.01);
}

TEST(BlurGate, RejectedFramesDoNotLowerTheBar) {
  Gate gate;
  gate.isBlurred(1);
  const double average = gate.average();
  gate.isBlurred(0.1);
  EXPECT_EQ(gate.average(), average);
}

// However few or many frames that is.
TEST(BlurGate, AcceptsTheNewSceneAfterTheLongestRejection) {
  BlurGateOptions options;
  options.longest_rejection_s = 0.05;
  Gate gate(options);
  gate.isBlurred(1);
  for (int frame = 0; frame < 5; ++frame) EXPECT_TRUE(gate.isBlurred(0.1));
  EXPECT_FALSE(gate.isBlurred(0.1));
  EXPECT_FALSE(gate.isBlurred(0.09));
}

TEST(BlurGate, ImageWithoutEdgesNeverPasses) {
  Gate gate;
  for (int frame = 0; frame < 40; ++frame) {
    EXPECT_TRUE(gate.isBlurred(0));
    EXPECT_TRUE(gate.isBlurred(std::nan("")));
  }
  EXPECT_FALSE(gate.isBlurred(0.01));
}

TEST(BlurGate, ShareOfZeroLetsAllEdgesPass) {
  BlurGateOptions options;
  options.share_of_average = 0;
  Gate gate(options);
  gate.isBlurred(1);
  EXPECT_FALSE(gate.isBlurred(1e-9));
}

}  // namespace
}  // namespace edgeslam
