// P3: the neighbours along an edge are the same ones on every instruction set.
#include "edges/edge_neighbours.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "edges/thinning.h"
#include "unit/edges/synthetic_image.h"
#include "unit/image/every_target.h"

namespace edgeslam {
namespace {

TEST(EdgeNeighbours, OctantIsTheNearestOfEightDirections) {
  for (int degrees = 0; degrees < 360; ++degrees) {
    const float angle = static_cast<float>(degrees * M_PI / 180);
    const int expected = static_cast<int>(std::lround(degrees / 45.0)) % 8;
    EXPECT_EQ(octant({std::cos(angle), std::sin(angle)}), expected) << degrees;
    EXPECT_EQ(octant({-std::cos(angle), -std::sin(angle)}), (expected + 4) % 8) << degrees;
  }
}

TEST(EdgeNeighbours, AreThoseOfTheReferenceOnEveryTarget) {
  size_t chosen = 0;
  onEveryTarget([&] {
    for (const cv::Mat& image :
         {renderTexture({320, 240}, 1), withNoise(renderTexture({201, 150}, 2), 4, 1),
          withNoise(cv::Mat(90, 120, CV_8U, cv::Scalar(128)), 60, 2), cv::Mat(40, 50, CV_8U, cv::Scalar(9)),
          renderLine({40, 30}, lineThrough(20, 15, 30))}) {
      DifferenceOfGaussians blurs;
      differenceOfGaussians(image, 1.78, 1.26, blurs);
      EdgePixels pixels;
      cv::Mat index;
      findEdgePixels(blurs, {}, pixels, index);
      thin(pixels.points, index);
      const size_t count = pixels.points.size();
      std::vector<int> ahead(count), behind(count), expected_ahead(count), expected_behind(count);
      chooseNeighbours(pixels.points, index, ahead, behind);
      chooseNeighboursReference(pixels.points, index, expected_ahead, expected_behind);
      EXPECT_EQ(ahead, expected_ahead);
      EXPECT_EQ(behind, expected_behind);
      for (const int next : ahead) chosen += next >= 0 ? 1 : 0;
    }
  });
  EXPECT_GT(chosen, 5000U);
}

TEST(EdgeNeighbours, OnlyMutualOnesStayAsByTheReferenceOnEveryTarget) {
  onEveryTarget([&] {
    std::mt19937 random(4);
    for (const int count : {0, 1, 3, 7, 8, 17, 64, 65, 1000}) {
      std::vector<int> ahead, behind;
      for (int i = 0; i < count; ++i) {
        const int kind = static_cast<int>(random() % 4);
        const int other = static_cast<int>(random() % static_cast<unsigned>(count));
        ahead.push_back(kind == 0 ? -1 : kind == 1 ? not_named : kind == 2 ? other : (i + 1) % count);
        behind.push_back(kind == 0 ? other : kind == 1 ? -1 : (i + count - 1) % count);
      }
      std::vector<int> expected_ahead = ahead, expected_behind = behind;
      keepMutual(ahead, behind);
      keepMutualReference(expected_ahead, expected_behind);
      EXPECT_EQ(ahead, expected_ahead);
      EXPECT_EQ(behind, expected_behind);
      for (size_t i = 0; i < ahead.size(); ++i) {
        if (ahead[i] >= 0) {
          EXPECT_EQ(behind[static_cast<size_t>(ahead[i])], static_cast<int>(i));
        }
        if (behind[i] >= 0) {
          EXPECT_EQ(ahead[static_cast<size_t>(behind[i])], static_cast<int>(i));
        }
      }
    }
  });
}

}  // namespace
}  // namespace edgeslam
