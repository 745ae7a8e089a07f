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

TEST(StructureTensor, ProductsAreThoseOfAPlainSum) {
  const cv::Mat image = withNoise(renderTexture({120, 90}, 4), 20, 1);
  const auto grey = [&](int x, int y) -> int {
    return image.at<uint8_t>(std::clamp(y, 0, image.rows - 1), std::clamp(x, 0, image.cols - 1));
  };
  for (const int window : {1, 3, 9, 15, 33}) {
    for (float y = -3; y < 95; y += 7.3F) {
      for (float x = -3; x < 125; x += 6.7F) {
        GradientProducts sum;
        for (int row = 0; row < image.rows; ++row) {
          for (int column = 0; column < image.cols; ++column) {
            const bool near =
                std::abs(row - std::lround(y)) <= window / 2 && std::abs(column - std::lround(x)) <= window / 2;
            if (!near) continue;
            const int along_x = grey(column + 1, row) - grey(column - 1, row);
            const int along_y = grey(column, row + 1) - grey(column, row - 1);
            sum.xx += along_x * along_x;
            sum.xy += along_x * along_y;
            sum.yy += along_y * along_y;
            ++sum.count;
          }
        }
        const GradientProducts products = gradientProducts(image, {x, y}, window);
        ASSERT_EQ(products.count, sum.count);
        ASSERT_EQ(products.xx, sum.xx) << x << " " << y << " " << window;
        ASSERT_EQ(products.xy, sum.xy);
        ASSERT_EQ(products.yy, sum.yy);
        const StructureTensor tensor = structureTensor(image, {x, y}, window);
        EXPECT_GE(tensor.l1, tensor.l2);
      }
    }
  }
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
