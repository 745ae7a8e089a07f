// P5: a patch is aligned where it was moved to, in other light and warped too.
#include "flow/patch_alignment.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <limits>
#include <vector>

#include "image/pyramid.h"
#include "unit/edges/synthetic_image.h"
#include "unit/flow/smooth_texture.h"

namespace edgeslam {
namespace {

constexpr int patch_side_px = 15;
const cv::Size patch_image_size{160, 120};

// With the border around that windows may read.
cv::Mat readable(const cv::Mat& image) { return buildPyramid(image, 1).levels[0]; }

PatchTemplate templateAt(const cv::Mat& image, const Eigen::Vector2f& pixel) {
  PatchTemplate patch;
  EXPECT_TRUE(makeTemplate(image, pixel, Eigen::Matrix2f::Identity(), patch_side_px, patch));
  return patch;
}

// What the patch tells of its place in the direction in which it tells least, once gain and bias are taken out
// [grey^2/px^2].
float leastTexture(const PatchTemplate& patch) {
  const Eigen::Matrix3f& h = patch.normal_matrix;
  const Eigen::Matrix2f free =
      h.topLeftCorner<2, 2>() - h.topRightCorner<2, 1>() * h.bottomLeftCorner<1, 2>() / h(2, 2);
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2f>(free).eigenvalues()(0) / (patch_side_px * patch_side_px);
}

// Error to be expected [px]: of the images' rounding and interpolation, and of the damping, which pulls towards a
// prediction that is wrong by `prediction_error` [px] with its share of the texture.
float allowedAlignmentError(const PatchTemplate& patch, float prediction_error) {
  return 0.03f + 1.5f * AlignmentOptions().damping * prediction_error / leastTexture(patch);
}

std::vector<Eigen::Vector2f> texturedPixels(const cv::Mat& image) {
  std::vector<Eigen::Vector2f> pixels;
  for (float y = 20.25f; y < 100; y += 11) {
    for (float x = 20.5f; x < 140; x += 11) {
      if (leastTexture(templateAt(image, {x, y})) > 70) pixels.emplace_back(x, y);
    }
  }
  EXPECT_GT(pixels.size(), 10U);
  return pixels;
}

TEST(PatchAlignment, FindsSubPixelShiftsOfTexture) {
  const SmoothTexture texture(1);
  const cv::Mat image = readable(texture.renderShifted(patch_image_size, {0, 0}));
  for (const Eigen::Vector2f& shift : {Eigen::Vector2f(0.3f, -0.7f), {1.25f, 0.5f}, {-1.6f, 1.1f}, {0, 0}}) {
    const cv::Mat moved = readable(texture.renderShifted(patch_image_size, shift.cast<double>()));
    const Eigen::Vector2f off(0.3f, -0.2f);
    for (const Eigen::Vector2f& pixel : texturedPixels(image)) {
      const PatchTemplate patch = templateAt(image, pixel);
      const AlignmentResult unpredicted = alignPatch(patch, moved, pixel, pixel, AlignmentOptions());
      EXPECT_TRUE(unpredicted.inside && unpredicted.converged);
      EXPECT_GT(unpredicted.correlation, 0.98f);
      EXPECT_LT((unpredicted.pixel - pixel - shift).norm(), allowedAlignmentError(patch, shift.norm()))
          << pixel.transpose() << ", by " << shift.transpose();
      const AlignmentResult predicted = alignPatch(patch, moved, pixel, pixel + shift + off, AlignmentOptions());
      EXPECT_LT((predicted.pixel - pixel - shift).norm(), 0.05f) << pixel.transpose() << ", by " << shift.transpose();
    }
  }
}

TEST(PatchAlignment, OnAStraightEdgeFindsTheWayAcrossAndKeepsToThePredictionAlong) {
  for (const double degrees : {0.0, 25.0, 45.0, 90.0, 140.0, 215.0}) {
    const Line line = lineThrough(80, 60, degrees);
    const cv::Mat image = readable(renderLine(patch_image_size, line));
    const Eigen::Vector2f pixel(80, 60), normal = line.normal.cast<float>(), tangent(-normal.y(), normal.x());
    const PatchTemplate patch = templateAt(image, pixel);
    for (const float across : {-1.4f, -0.3f, 0.6f, 1.7f}) {
      Line moved_line = line;
      moved_line.offset += across;
      const cv::Mat moved = readable(renderLine(patch_image_size, moved_line));
      for (const float along : {-6.0f, 0.0f, 4.5f}) {
        const Eigen::Vector2f prediction = pixel + along * tangent;
        const AlignmentResult found = alignPatch(patch, moved, prediction, prediction, AlignmentOptions());
        EXPECT_TRUE(found.inside);
        EXPECT_NEAR((found.pixel - pixel).dot(normal), across, 0.05) << degrees << " deg";
        EXPECT_NEAR((found.pixel - pixel).dot(tangent), along, 0.25) << degrees << " deg";
      }
    }
  }
}

TEST(PatchAlignment, ThePredictionHoldsAlongAnEdgeEvenWhereTheStartWasElsewhere) {
  const Line line = lineThrough(80, 60, 30);
  const cv::Mat image = readable(renderLine(patch_image_size, line));
  const Eigen::Vector2f pixel(80, 60), normal = line.normal.cast<float>(), tangent(-normal.y(), normal.x());
  const AlignmentResult found =
      alignPatch(templateAt(image, pixel), image, pixel + 3 * tangent, pixel - tangent, AlignmentOptions());
  EXPECT_NEAR((found.pixel - pixel).dot(normal), 0, 0.05);
  EXPECT_NEAR((found.pixel - pixel).dot(tangent), -1, 0.1);
}

TEST(PatchAlignment, GainAndBiasChangeNothing) {
  const SmoothTexture texture(2);
  const cv::Mat image = readable(texture.renderShifted(patch_image_size, {0, 0}));
  const Eigen::Vector2f shift(0.8f, -0.6f);
  cv::Mat moved = texture.renderShifted(patch_image_size, shift.cast<double>());
  moved.convertTo(moved, CV_8U, 0.7, 35);
  moved = readable(moved);
  for (const Eigen::Vector2f& pixel : texturedPixels(image)) {
    const PatchTemplate patch = templateAt(image, pixel);
    const AlignmentResult found = alignPatch(patch, moved, pixel, pixel, AlignmentOptions());
    EXPECT_LT((found.pixel - pixel - shift).norm(), allowedAlignmentError(patch, 1)) << pixel.transpose();
    EXPECT_GT(found.correlation, 0.98f);
  }
}

TEST(PatchAlignment, AWarpedTemplateIsFoundInARotatedAndScaledImage) {
  const SmoothTexture texture(3);
  const cv::Mat image = readable(texture.renderShifted(patch_image_size, {0, 0}));
  const Eigen::Vector2d centre(80, 60);
  const double angle = 40 * M_PI / 180, scale = 1.4;
  Eigen::Matrix2d image_by_moved;
  image_by_moved << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  image_by_moved /= scale;
  const cv::Mat moved = readable(texture.render(patch_image_size, [&](const Eigen::Vector2d& p) -> Eigen::Vector2d {
    return centre + image_by_moved * (p - centre);
  }));
  const Eigen::Vector2f start = centre.cast<float>() + Eigen::Vector2f(0.7f, -0.9f);
  PatchTemplate patch;
  ASSERT_TRUE(makeTemplate(image, centre.cast<float>(), image_by_moved.cast<float>(), patch_side_px, patch));
  const AlignmentResult found = alignPatch(patch, moved, start, start, AlignmentOptions());
  EXPECT_LT((found.pixel - centre.cast<float>()).norm(), allowedAlignmentError(patch, 1.14f));
  EXPECT_GT(found.correlation, 0.99f);
  const AlignmentResult unwarped = alignPatch(templateAt(image, centre.cast<float>()), moved, start, start, {});
  EXPECT_LT(unwarped.correlation, found.correlation - 0.05f);
}

TEST(PatchAlignment, TheTensorIsTheMeanOfTheGradientsProducts) {
  // A ramp of 3 grey/px to the right and 1 downwards.
  cv::Mat ramp(patch_image_size, CV_8U);
  for (int y = 0; y < patch_image_size.height; ++y) {
    for (int x = 0; x < patch_image_size.width; ++x)
      ramp.at<unsigned char>(y, x) = static_cast<unsigned char>((3 * x + y) % 256);
  }
  const PatchTemplate patch = templateAt(readable(ramp), {40, 60});
  EXPECT_NEAR(patch.tensor(0, 0), 9, 1e-3);
  EXPECT_NEAR(patch.tensor(1, 1), 1, 1e-3);
  EXPECT_NEAR(patch.tensor(0, 1), 3, 1e-3);
}

TEST(PatchAlignment, PatchesThatLeaveTheReadablePartOrAreNotNumbersAreRefused) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  const SmoothTexture texture(4);
  const cv::Mat image = readable(texture.renderShifted(patch_image_size, {0, 0}));
  const PatchTemplate patch = templateAt(image, {80, 60});
  PatchTemplate refused;
  for (const Eigen::Vector2f& pixel :
       {Eigen::Vector2f(nan, 60), {80, nan}, {infinity, 60}, {-40, 60}, {80, 160}, {1e9f, 1e9f}, {-1e30f, 0}}) {
    EXPECT_FALSE(makeTemplate(image, pixel, Eigen::Matrix2f::Identity(), patch_side_px, refused)) << pixel.transpose();
    EXPECT_FALSE(alignPatch(patch, image, pixel, pixel, AlignmentOptions()).inside) << pixel.transpose();
    EXPECT_FALSE(alignPatch(patch, image, pixel, {80, 60}, AlignmentOptions()).inside) << pixel.transpose();
  }
  EXPECT_FALSE(alignPatch(patch, image, {80, 60}, {nan, 60}, AlignmentOptions()).inside);
  EXPECT_FALSE(makeTemplate(image, {80, 60}, Eigen::Matrix2f::Constant(nan), patch_side_px, refused));
  EXPECT_FALSE(makeTemplate(image, {80, 60}, 100 * Eigen::Matrix2f::Identity(), patch_side_px, refused));
}

TEST(PatchAlignment, AFlatPatchStaysWhereItWasPredictedAndIsLikeNothing) {
  const cv::Mat flat = readable(cv::Mat(patch_image_size, CV_8U, cv::Scalar(117)));
  const Eigen::Vector2f prediction(70.4f, 51.8f);
  const AlignmentResult in_flat =
      alignPatch(templateAt(flat, {80, 60}), flat, prediction, prediction, AlignmentOptions());
  EXPECT_LT((in_flat.pixel - prediction).norm(), 1e-3f);
  EXPECT_LT(std::abs(in_flat.correlation), 0.1f);
  const SmoothTexture texture(5);
  const cv::Mat image = readable(texture.renderShifted(patch_image_size, {0, 0}));
  EXPECT_LT(std::abs(alignPatch(templateAt(flat, {80, 60}), image, {80, 60}, {80, 60}, AlignmentOptions()).correlation),
            0.1f);
  EXPECT_LT(std::abs(alignPatch(templateAt(image, {80, 60}), flat, {80, 60}, {80, 60}, AlignmentOptions()).correlation),
            0.1f);
}

}  // namespace
}  // namespace edgeslam
