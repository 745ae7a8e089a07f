// P1, P2: edges lie where they were drawn, one pixel wide, whatever the lighting.
#include "edges/edge_detection.h"

#include <gtest/gtest.h>

#include <cstring>

#include "edges/zero_crossing.h"
#include "unit/edges/synthetic_image.h"

namespace edgeslam {
namespace {

constexpr double kDegrees = 180 / M_PI;
const cv::Size line_image_size(121, 101);

bool nearBorder(const EdgePoint& point, const cv::Size& size, float margin = 8) {
  return point.pixel.x() < margin || point.pixel.y() < margin ||
         point.pixel.x() > static_cast<float>(size.width) - margin ||
         point.pixel.y() > static_cast<float>(size.height) - margin;
}

struct LineErrors {
  double position_rms = 0;  // [px]
  double normal_rms = 0;    // [deg]
  double normal_worst = 0;  // [deg]
  size_t points = 0;
};

// Of lines of all directions and sub-pixel positions.
LineErrors measureLines(double noise, double dark, double bright) {
  LineErrors errors;
  unsigned seed = 1;
  for (double degrees = 0; degrees < 360; degrees += 11.25) {
    for (const double shift : {0.0, 0.3, 0.5}) {
      const Line line = lineThrough(60 + shift, 50, degrees);
      const EdgeMap edges = detectEdges(withNoise(renderLine(line_image_size, line, dark, bright), noise, seed++), {});
      for (const EdgePoint& point : edges.points) {
        if (nearBorder(point, line_image_size)) continue;
        const double distance = line.distance(point.pixel.x(), point.pixel.y());
        const Eigen::Vector2d normal = point.normal.cast<double>();
        const double cross = line.normal.x() * normal.y() - line.normal.y() * normal.x();
        const double turn = std::abs(std::atan2(cross, line.normal.dot(normal))) * kDegrees;
        errors.position_rms += distance * distance;
        errors.normal_rms += turn * turn;
        errors.normal_worst = std::max(errors.normal_worst, turn);
        ++errors.points;
      }
    }
  }
  errors.position_rms = std::sqrt(errors.position_rms / static_cast<double>(errors.points));
  errors.normal_rms = std::sqrt(errors.normal_rms / static_cast<double>(errors.points));
  return errors;
}

TEST(EdgeDetection, FindsLinesOfAllDirectionsToAFractionOfAPixel) {
  const LineErrors errors = measureLines(0, 60, 180);
  EXPECT_LT(errors.position_rms, 0.02);
  EXPECT_LT(errors.normal_worst, 2.0);
  EXPECT_GT(errors.points, 96U * 80U);
}

TEST(EdgeDetection, NoiseMovesEdgesLittle) {
  const LineErrors strong = measureLines(2, 60, 180);
  EXPECT_LT(strong.position_rms, 0.05);
  EXPECT_LT(strong.normal_rms, 1.0);
  const LineErrors weak = measureLines(2, 90, 110);
  EXPECT_LT(weak.position_rms, 0.2);
  EXPECT_LT(weak.normal_rms, 3.0);
}

TEST(EdgeDetection, NormalPointsFromDarkToBrightWithTheGradientAcross) {
  for (const double degrees : {0.0, 30.0, 120.0, 225.0, 300.0}) {
    const Line line = lineThrough(60.2, 50.1, degrees);
    const EdgeMap edges = detectEdges(renderLine(line_image_size, line, 60, 180), {});
    ASSERT_FALSE(edges.points.empty());
    // A step of 120 grey values under the lens' and the narrower Gaussian.
    const double expected = 120 / (std::sqrt(2 * M_PI) * std::hypot(EdgeOptions().sigma, 0.6));
    for (const EdgePoint& point : edges.points) {
      if (nearBorder(point, line_image_size)) continue;
      EXPECT_NEAR(point.normal.norm(), 1, 1e-5);
      EXPECT_GT(point.normal.cast<double>().dot(line.normal), 0.99);
      EXPECT_NEAR(point.gradient, expected, 0.1 * expected);
    }
  }
}

TEST(EdgeDetection, LineIsOneUnbrokenChainOnePixelWide) {
  for (double degrees = 0; degrees < 360; degrees += 7) {
    const Line line = lineThrough(60.4, 50.3, degrees);
    const EdgeMap edges = detectEdges(renderLine(line_image_size, line), {});
    EXPECT_EQ(edges.chain_count, 1) << degrees;
    for (size_t i = 0; i < edges.points.size(); ++i) {
      for (size_t j = i + 1; j < edges.points.size(); ++j) {
        const Eigen::Vector2f difference = edges.points[j].pixel - edges.points[i].pixel;
        // About a pixel apart along the line; nearer only where its pixels are counted now by rows, now by columns.
        ASSERT_GT(difference.norm(), 0.65F) << "two points on one place, line at " << degrees << " degrees";
      }
      const int next = edges.points[i].next;
      if (next < 0) continue;
      EXPECT_LT((edges.points[static_cast<size_t>(next)].pixel - edges.points[i].pixel).norm(), 2.1F) << degrees;
    }
  }
}

TEST(EdgeDetection, ThinLineGivesBothItsSidesUnbroken) {
  for (const double degrees : {3.0, 45.0, 80.0}) {
    const Line line = lineThrough(60.4, 50.3, degrees);
    const cv::Mat image = renderEdge(
        line_image_size, [&](double x, double y) { return std::abs(line.distance(x, y)) - 1.0; }, 60, 120);
    const EdgeMap edges = detectEdges(image, {});
    EXPECT_EQ(edges.chain_count, 2) << degrees;
    for (const EdgePoint& point : edges.points) {
      if (nearBorder(point, line_image_size)) continue;
      const double distance = line.distance(point.pixel.x(), point.pixel.y());
      EXPECT_NEAR(std::abs(distance), 2.2, 0.2);
      EXPECT_GT(distance * point.normal.cast<double>().dot(line.normal), 0);
    }
  }
}

TEST(EdgeDetection, ContrastAndBrightnessLeaveEdgesWhereTheyAre) {
  const cv::Mat image = renderTexture(cv::Size(200, 150), 5);
  cv::Mat dimmed;
  image.convertTo(dimmed, CV_8U, 0.6, 20);
  const EdgeMap bright = detectEdges(image, {});
  const EdgeMap dim = detectEdges(dimmed, {});
  size_t strong = 0;
  size_t found = 0;
  double squares = 0;
  for (const EdgePoint& point : bright.points) {
    if (point.gradient < 5) continue;  // weaker ones may fall below the threshold
    ++strong;
    const int match = nearestEdgePoint(dim, point.pixel, point.normal, 0.5F, 0.9F);
    if (match < 0) continue;
    ++found;
    squares += (dim.points[static_cast<size_t>(match)].pixel - point.pixel).squaredNorm();
  }
  ASSERT_GT(strong, 1000U);
  EXPECT_GT(found, strong * 98 / 100);
  EXPECT_LT(std::sqrt(squares / static_cast<double>(found)), 0.05);
}

TEST(EdgeDetection, DiscIsOneClosedChain) {
  const Eigen::Vector2d centre(60.3, 49.8);
  const EdgeMap edges = detectEdges(renderDisc(line_image_size, centre, 30), {});
  ASSERT_EQ(edges.chain_count, 1);
  int at = 0;
  for (size_t i = 0; i < edges.points.size(); ++i) {
    const EdgePoint& point = edges.points[static_cast<size_t>(at)];
    EXPECT_NEAR((point.pixel.cast<double>() - centre).norm(), 30, 0.15);
    // The centre is brighter.
    EXPECT_LT(point.normal.cast<double>().dot((point.pixel.cast<double>() - centre).normalized()), -0.99);
    at = point.next;
    ASSERT_GE(at, 0);
  }
  EXPECT_EQ(at, 0);
}

TEST(EdgeDetection, ImagesWithoutEdgesGiveNone) {
  EXPECT_TRUE(detectEdges(cv::Mat(), {}).points.empty());
  EXPECT_TRUE(detectEdges(cv::Mat(48, 64, CV_8U, cv::Scalar(0)), {}).points.empty());
  EXPECT_TRUE(detectEdges(cv::Mat(48, 64, CV_8U, cv::Scalar(255)), {}).points.empty());
  EXPECT_TRUE(detectEdges(withNoise(cv::Mat(101, 121, CV_8U, cv::Scalar(128)), 1, 3), {}).points.empty());
  const Line smooth = lineThrough(60, 50, 20);
  const cv::Mat shading = renderEdge(
      line_image_size, [&](double x, double y) { return smooth.distance(x, y); }, 100, 140, 30);
  EXPECT_TRUE(detectEdges(shading, {}).points.empty());
}

TEST(EdgeDetection, TakesImagesOfAnySize) {
  for (const cv::Size& size : {cv::Size(1, 1), cv::Size(3, 3), cv::Size(9, 9), cv::Size(200, 1), cv::Size(1, 200),
                               cv::Size(37, 23), cv::Size(8, 64)}) {
    const EdgeMap edges = detectEdges(renderLine(size, lineThrough(size.width / 2.0, size.height / 2.0, 0)), {});
    EXPECT_EQ(edges.index.size(), size);
    EXPECT_EQ(edges.chain_count > 0, size.width > 30 && size.height > 20) << size;
  }
}

TEST(EdgeDetection, WorksWithAllOptionsThatMayBeSet) {
  const cv::Mat image = renderTexture(cv::Size(160, 120), 6);
  for (const double sigma : {0.3, 1.0, 3.0, 10.0}) {
    for (const double ratio : {1.05, 1.6, 4.0}) {
      for (int radius = 1; radius <= largest_fit_radius; ++radius) {
        EdgeOptions options;
        options.sigma = sigma;
        options.sigma_ratio = ratio;
        options.plane_fit_radius = radius;
        options.gradient_threshold = 0;
        const EdgeMap edges = detectEdges(image, options);
        // A window far wider or narrower than the Gaussians tells no edges.
        if (radius == 2 && sigma >= 1 && sigma <= 3) {
          EXPECT_GT(edges.points.size(), 100U) << sigma << " " << ratio;
        }
        for (const EdgePoint& point : edges.points) ASSERT_TRUE(point.pixel.allFinite() && point.normal.allFinite());
      }
    }
  }
}

TEST(EdgeDetection, ReadsAPartOfALargerImageAsIfItWereWhole) {
  const cv::Mat image = renderTexture(cv::Size(200, 150), 7);
  const cv::Mat part = image(cv::Rect(31, 17, 90, 80));
  const EdgeMap of_view = detectEdges(part, {});
  const EdgeMap of_copy = detectEdges(part.clone(), {});
  ASSERT_GT(of_view.points.size(), 100U);
  ASSERT_EQ(of_view.points.size(), of_copy.points.size());
  for (size_t i = 0; i < of_view.points.size(); ++i) EXPECT_EQ(of_view.points[i].pixel, of_copy.points[i].pixel);
}

TEST(EdgeDetection, RepeatsToTheLastBit) {
  const cv::Mat image = withNoise(renderTexture(cv::Size(160, 120), 9), 2, 1);
  const EdgeMap first = detectEdges(image, {});
  const EdgeMap second = detectEdges(image.clone(), {});
  ASSERT_GT(first.points.size(), 300U);
  ASSERT_EQ(first.points.size(), second.points.size());
  for (size_t i = 0; i < first.points.size(); ++i) {
    EXPECT_EQ(std::memcmp(&first.points[i], &second.points[i], sizeof(EdgePoint)), 0);
  }
}

TEST(NearestEdgePoint, AgreesWithSearchingAllPoints) {
  const EdgeMap edges = detectEdges(renderTexture(cv::Size(160, 120), 11), {});
  std::mt19937 generator(2);
  std::uniform_real_distribution<float> x(-5, 165);
  std::uniform_real_distribution<float> y(-5, 125);
  int found = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Eigen::Vector2f pixel(x(generator), y(generator));
    const Eigen::Vector2f normal = Eigen::Vector2f(x(generator) - 80, y(generator) - 60).normalized();
    const float radius = 0.5F + 0.02F * static_cast<float>(trial % 200);
    const float least_dot = trial % 3 == 0 ? -1.0F : 0.7F;
    float nearest = radius;
    bool any = false;
    for (const EdgePoint& point : edges.points) {
      const float distance = (point.pixel - pixel).norm();
      if (point.normal.dot(normal) < least_dot || distance > nearest) continue;
      nearest = distance;
      any = true;
    }
    const int index = nearestEdgePoint(edges, pixel, normal, radius, least_dot);
    ASSERT_EQ(index >= 0, any);
    if (!any) continue;
    ++found;
    EXPECT_FLOAT_EQ((edges.points[static_cast<size_t>(index)].pixel - pixel).norm(), nearest);
  }
  EXPECT_GT(found, 200);
}

TEST(NearestEdgePoint, FindsNothingInAnEmptyMapOrAtNoPlace) {
  EXPECT_EQ(nearestEdgePoint({}, {5, 5}, {1, 0}, 3, -1), -1);
  const EdgeMap edges = detectEdges(renderLine(line_image_size, lineThrough(60, 50, 0)), {});
  EXPECT_EQ(nearestEdgePoint(edges, {std::nanf(""), 5}, {1, 0}, 3, -1), -1);
  EXPECT_EQ(nearestEdgePoint(edges, {1e30F, -1e30F}, {1, 0}, 3, -1), -1);
  EXPECT_EQ(nearestEdgePoint(edges, {20, 50}, {1, 0}, 3, -1), -1);
  EXPECT_GE(nearestEdgePoint(edges, {58.5F, 50}, {1, 0}, 3, 0.9F), 0);
  EXPECT_EQ(nearestEdgePoint(edges, {58.5F, 50}, {-1, 0}, 3, 0.9F), -1) << "a normal the other way is another edge";
}

// Whatever the robot's body looks like, the edges are those of the rest.
TEST(EdgeDetection, WhatIsMaskedIsNotLookedAt) {
  const cv::Size size(320, 240);
  const cv::Mat scene = withNoise(renderLine(size, lineThrough(150, 120, 20)), 2, 1);
  cv::Mat mask_image(size, CV_8U, cv::Scalar(255)), other = scene.clone();
  mask_image.rowRange(0, 90).setTo(0);
  renderTexture({320, 90}, 3).copyTo(other.rowRange(0, 90));
  const auto mask = makeCameraMask(mask_image);
  const EdgeMap all = detectEdges(scene, {}), seen = detectEdges(scene, {}, mask.get());
  ASSERT_GT(seen.points.size(), 50U);
  EXPECT_GT(all.points.size(), seen.points.size());
  for (const EdgePoint& point : seen.points) EXPECT_FALSE(isHidden(mask.get(), point.pixel.cast<double>()));
  const EdgeMap with_other = detectEdges(other, {}, mask.get());
  ASSERT_EQ(with_other.points.size(), seen.points.size());
  for (size_t i = 0; i < seen.points.size(); ++i) {
    EXPECT_LT((with_other.points[i].pixel - seen.points[i].pixel).norm(), 0.005F);
    EXPECT_GT(with_other.points[i].normal.dot(seen.points[i].normal), 0.9999F);
  }
}

}  // namespace
}  // namespace edgeslam
