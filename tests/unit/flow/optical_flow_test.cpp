// P5: the flow follows patches through the pyramid, forward and backward.
#include "flow/optical_flow.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "unit/edges/synthetic_image.h"
#include "unit/flow/smooth_texture.h"

namespace edgeslam {
namespace {

const cv::Size flow_image_size{240, 180};

ImagePyramid pyramidOf(const cv::Mat& image) { return buildPyramid(image, 4); }

float leastEigenvalue(const Eigen::Matrix2f& tensor) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2f>(tensor).eigenvalues()(0);
}

std::vector<Eigen::Vector2f> gridOfPixels() {
  std::vector<Eigen::Vector2f> pixels;
  for (float y = 40.3f; y < 145; y += 17) {
    for (float x = 40.6f; x < 205; x += 17) pixels.emplace_back(x, y);
  }
  return pixels;
}

// The damping pulls towards the prediction: what is left of the prediction's error is the damping's share of the
// texture.
float allowedFlowError(const FlowMatch& match, float prediction_error) {
  return 0.03f + 3 * static_cast<float>(FlowOptions().damping) * prediction_error / leastEigenvalue(match.tensor);
}

TEST(OpticalFlow, FollowsShiftsThatWerePredictedWithinTwoPixels) {
  const SmoothTexture texture(11);
  const ImagePyramid from = pyramidOf(texture.renderShifted(flow_image_size, {0, 0}));
  int followed = 0, exact = 0;
  for (const Eigen::Vector2f& shift : {Eigen::Vector2f(18.3f, -6.1f), {-20, 3.7f}, {0.45f, 19.6f}, {2.2f, -1.9f}}) {
    const ImagePyramid to = pyramidOf(texture.renderShifted(flow_image_size, shift.cast<double>()));
    for (const Eigen::Vector2f& pixel : gridOfPixels()) {
      const FlowMatch match = followPoint(from, to, pixel, pixel + shift + Eigen::Vector2f(1.2f, -1.6f), FlowOptions());
      if (leastEigenvalue(match.tensor) < 60) continue;
      ++followed;
      const float error = (match.pixel - pixel - shift).norm();
      exact += error < 0.05f;
      EXPECT_TRUE(match.found);
      EXPECT_LT(error, allowedFlowError(match, 2)) << pixel.transpose() << ", by " << shift.transpose();
    }
  }
  EXPECT_GT(followed, 100);
  EXPECT_GT(exact, 0.5 * followed);
}

TEST(OpticalFlow, FollowsShiftsOfTwentyPixelsWithoutAnyPrediction) {
  const SmoothTexture texture(12);
  const ImagePyramid from = pyramidOf(texture.renderShifted(flow_image_size, {0, 0}));
  int textured = 0, followed = 0;
  for (const Eigen::Vector2f& shift : {Eigen::Vector2f(20, 0), {-14, 14}, {8.5f, -18}}) {
    const ImagePyramid to = pyramidOf(texture.renderShifted(flow_image_size, shift.cast<double>()));
    for (const Eigen::Vector2f& pixel : gridOfPixels()) {
      const FlowMatch match = followPoint(from, to, pixel, pixel, FlowOptions());
      if (leastEigenvalue(match.tensor) < 60) continue;
      ++textured;
      followed += match.found && (match.pixel - pixel - shift).norm() < allowedFlowError(match, 20);
    }
  }
  EXPECT_GT(textured, 60);
  EXPECT_GT(followed, 0.95 * textured);
}

TEST(OpticalFlow, ABlurredImageIsFollowedOnCoarserLevels) {
  const SmoothTexture texture(13);
  const Eigen::Vector2f shift(7.2f, -4.6f);
  const ImagePyramid from = pyramidOf(texture.renderShifted(flow_image_size, {0, 0}));
  cv::Mat blurred;
  cv::GaussianBlur(texture.renderShifted(flow_image_size, shift.cast<double>()), blurred, {}, 4);
  const ImagePyramid to = pyramidOf(blurred);
  FlowOptions coarse;
  coarse.finest_level = 2;
  int points = 0, near_coarsely = 0, near_finely = 0;
  for (const Eigen::Vector2f& pixel : gridOfPixels()) {
    const auto isNear = [&](const FlowOptions& options) {
      const FlowMatch match = followPoint(from, to, pixel, pixel + shift + Eigen::Vector2f(1.5f, -1), options);
      return match.found && (match.pixel - pixel - shift).norm() < 1;
    };
    ++points;
    near_coarsely += isNear(coarse);
    near_finely += isNear(FlowOptions());
  }
  EXPECT_GT(near_coarsely, 0.8 * points);
  EXPECT_LT(near_finely, 0.7 * near_coarsely);
}

TEST(OpticalFlow, FollowsUnderRotationAndScale) {
  const SmoothTexture texture(13);
  const ImagePyramid from = pyramidOf(texture.renderShifted(flow_image_size, {0, 0}));
  const Eigen::Vector2d centre(120, 90);
  const double angle = 1.5 * M_PI / 180;
  Eigen::Matrix2d turn;
  turn << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  turn *= 1.015;
  const ImagePyramid to = pyramidOf(texture.render(flow_image_size, [&](const Eigen::Vector2d& p) -> Eigen::Vector2d {
    return centre + turn.inverse() * (p - centre);
  }));
  int followed = 0;
  for (const Eigen::Vector2f& pixel : gridOfPixels()) {
    const Eigen::Vector2f there = (centre + turn * (pixel.cast<double>() - centre)).cast<float>();
    const FlowMatch match = followPoint(from, to, pixel, pixel, FlowOptions());
    if (leastEigenvalue(match.tensor) < 60) continue;
    ++followed;
    EXPECT_TRUE(match.found);
    // A patch of 15 pixels that turns is not the same patch any more.
    EXPECT_LT((match.pixel - there).norm(), 0.2f + allowedFlowError(match, (there - pixel).norm()))
        << pixel.transpose();
  }
  EXPECT_GT(followed, 20);
}

TEST(OpticalFlow, APointOfAStraightEdgeMovesAcrossAndIsHeldAlong) {
  for (const double degrees : {10.0, 60.0, 120.0, 275.0}) {
    const Line line = lineThrough(120, 90, degrees);
    Line moved_line = line;
    moved_line.offset += 7.4;
    const ImagePyramid from = pyramidOf(renderLine(flow_image_size, line)),
                       to = pyramidOf(renderLine(flow_image_size, moved_line));
    const Eigen::Vector2f pixel(120, 90), normal = line.normal.cast<float>(), tangent(-normal.y(), normal.x());
    const Eigen::Vector2f prediction = pixel + 6.0f * normal + 5.0f * tangent;
    const FlowMatch match = followPoint(from, to, pixel, prediction, FlowOptions());
    ASSERT_TRUE(match.found);
    EXPECT_NEAR((match.pixel - pixel).dot(normal), 7.4, 0.05) << degrees << " deg";
    EXPECT_NEAR((match.pixel - pixel).dot(tangent), 5, 0.25) << degrees << " deg";
    EXPECT_LT(backwardError(from, to, pixel, match.pixel, normal, FlowOptions()), 0.05f) << degrees << " deg";
  }
}

TEST(OpticalFlow, FindsNothingInAnotherImage) {
  const ImagePyramid from = pyramidOf(SmoothTexture(14, 6, 20).renderShifted(flow_image_size, {0, 0}));
  const ImagePyramid other = pyramidOf(SmoothTexture(15, 6, 20).renderShifted(flow_image_size, {0, 0}));
  const ImagePyramid flat = pyramidOf(cv::Mat(flow_image_size, CV_8U, cv::Scalar(80)));
  int found = 0, points = 0;
  for (const Eigen::Vector2f& pixel : gridOfPixels()) {
    ++points;
    found += followPoint(from, other, pixel, pixel, FlowOptions()).found;
    EXPECT_FALSE(followPoint(from, flat, pixel, pixel, FlowOptions()).found);
    EXPECT_FALSE(followPoint(flat, from, pixel, pixel, FlowOptions()).found);
  }
  EXPECT_LT(found, 0.1 * points);
}

TEST(OpticalFlow, BackwardErrorTellsAWrongMatch) {
  const SmoothTexture texture(16);
  const ImagePyramid from = pyramidOf(texture.renderShifted(flow_image_size, {0, 0}));
  const ImagePyramid to = pyramidOf(texture.renderShifted(flow_image_size, {3.5, 1.25}));
  const Eigen::Vector2f pixel(110, 80), right = pixel + Eigen::Vector2f(3.5f, 1.25f);
  for (const Eigen::Vector2f& across : {Eigen::Vector2f(1, 0), {0, 1}, {0.6f, -0.8f}}) {
    EXPECT_LT(backwardError(from, to, pixel, right, across, FlowOptions()), 0.1f);
    EXPECT_GT(backwardError(from, to, pixel, right + 4 * across, across, FlowOptions()), 2.0f);
  }
  const ImagePyramid flat = pyramidOf(cv::Mat(flow_image_size, CV_8U, cv::Scalar(80)));
  EXPECT_EQ(backwardError(from, flat, pixel, right, {1, 0}, FlowOptions()), std::numeric_limits<float>::max());
}

TEST(OpticalFlow, PointsOutsideOrNotANumberAreNotFound) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  const ImagePyramid image = pyramidOf(SmoothTexture(17).renderShifted(flow_image_size, {0, 0}));
  for (const Eigen::Vector2f& pixel : {Eigen::Vector2f(nan, 50), {-60, 50}, {50, 900}, {1e20f, 1e20f}}) {
    EXPECT_FALSE(followPoint(image, image, pixel, {100, 90}, FlowOptions()).found);
    EXPECT_FALSE(followPoint(image, image, {100, 90}, pixel, FlowOptions()).found);
  }
}

TEST(OpticalFlow, PyramidsOfDifferentHeightsShareTheirLowerLevels) {
  const SmoothTexture texture(18);
  const ImagePyramid tall = buildPyramid(texture.renderShifted(flow_image_size, {0, 0}), 4);
  const ImagePyramid low = buildPyramid(texture.renderShifted(flow_image_size, {1.2, 0.4}), 2);
  const Eigen::Vector2f pixel(100, 90);
  const FlowMatch match = followPoint(tall, low, pixel, pixel, FlowOptions());
  EXPECT_TRUE(match.found);
  EXPECT_LT((match.pixel - pixel - Eigen::Vector2f(1.2f, 0.4f)).norm(), 0.05f);
}

}  // namespace
}  // namespace edgeslam
