// How well a track is known across and along its edge.
#include "tracking/measurement_accuracy.h"

#include <gtest/gtest.h>

#include "unit/edges/synthetic_image.h"
#include "unit/tracking/textured_plane.h"

namespace edgeslam {
namespace {

const cv::Size small_size{120, 100};

TEST(MeasurementAccuracy, AnEdgePointIsKnownAcrossAndNotAlong) {
  const PointAccuracyOptions options;
  for (const double degrees : {0.0, 30.0, 100.0, 200.0}) {
    const Line line = lineThrough(60, 50, degrees);
    Track track = trackAt(0, {60, 50}, line.normal.cast<float>() + Eigen::Vector2f(0.2f, -0.1f));
    updateAccuracy(renderLine(small_size, line), {options}, track);
    EXPECT_GT(track.normal.dot(line.normal.cast<float>()), 0.999f) << degrees;
    EXPECT_FALSE(track.corner);
    EXPECT_EQ(track.sigma_normal, static_cast<float>(options.sigma_edge));
    EXPECT_GT(track.sigma_tangent, 10 * track.sigma_normal) << degrees;
  }
}

// From dark to bright it is only told by the edge; the tensor has no sign.
TEST(MeasurementAccuracy, TheNormalKeepsItsSide) {
  const Line line = lineThrough(60, 50, 40);
  const cv::Mat image = renderLine(small_size, line);
  for (const float side : {1.0f, -1.0f}) {
    Track track = trackAt(0, {60, 50}, side * line.normal.cast<float>());
    updateAccuracy(image, {}, track);
    EXPECT_GT(side * track.normal.dot(line.normal.cast<float>()), 0.999f);
  }
}

TEST(MeasurementAccuracy, ACornerIsKnownInBothDirections) {
  const PointAccuracyOptions options;
  Track track = trackAt(0, {59.5f, 39.5f}, {1, 0});  // where four squares of 20 px meet
  updateAccuracy(renderCheckerboard(small_size, 20), {options}, track);
  EXPECT_TRUE(track.corner);
  EXPECT_EQ(track.sigma_normal, static_cast<float>(options.sigma_corner));
  EXPECT_LT(track.sigma_tangent, 2 * track.sigma_normal);
}

TEST(MeasurementAccuracy, ATrackThatBecomesACornerAndLeavesItAgainIsRenewed) {
  const PointAccuracyOptions options;
  const cv::Mat image = renderCheckerboard(small_size, 30);
  Track track = trackAt(0, {59.5f, 59.5f}, {1, 0});
  updateAccuracy(image, {options}, track);
  EXPECT_TRUE(track.corner);
  track.pixel = {59.5f, 44.5f};  // half way to the next
  updateAccuracy(image, {options}, track);
  EXPECT_FALSE(track.corner);
  EXPECT_EQ(track.sigma_normal, static_cast<float>(options.sigma_edge));
  EXPECT_NEAR(std::abs(track.normal.x()), 1, 1e-3);
}

TEST(MeasurementAccuracy, NoiseTellsNothingOfThePlaceAlongAnEdge) {
  const PointAccuracyOptions options;
  const cv::Mat noisy = withNoise(renderLine(small_size, lineThrough(60, 50, 20)), 2.0, 5);
  Track track = trackAt(0, {60, 50}, {1, 0.3f});
  updateAccuracy(noisy, {options}, track);
  EXPECT_FALSE(track.corner);
  EXPECT_GT(track.sigma_tangent, 10 * track.sigma_normal);
}

TEST(MeasurementAccuracy, NorDoesMuchNoiseInDimLight) {
  const cv::Mat dim = withNoise(renderLine(small_size, lineThrough(60, 50, 20), 60, 95), 5.0, 5);
  Track track = trackAt(0, {60, 50}, {1, 0.3f});
  updateAccuracy(dim, {}, track);
  EXPECT_TRUE(track.corner) << "without the image's noise";
  updateAccuracy(dim, accuracyIn(dim, {}), track);
  EXPECT_FALSE(track.corner);
  EXPECT_GT(track.sigma_tangent, 5 * track.sigma_normal);
}

TEST(MeasurementAccuracy, SigmasStayFiniteOnAFlatImage) {
  Track track = trackAt(0, {60, 50}, {1, 0});
  updateAccuracy(cv::Mat(small_size, CV_8U, cv::Scalar(90)), {}, track);
  EXPECT_FALSE(track.corner);
  EXPECT_GT(track.sigma_normal, 0);
  EXPECT_TRUE(std::isfinite(track.sigma_tangent));
  EXPECT_TRUE(track.normal.allFinite());
  EXPECT_NEAR(track.normal.norm(), 1, 1e-5);
}

}  // namespace
}  // namespace edgeslam
