// P26: descriptors find the same points in another view.
#include "places/keyframe_matching.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "unit/places/made_place.h"

namespace edgeslam {
namespace {

std::vector<Eigen::Vector2f> edgePixels(const cv::Mat& grey) {
  PointChoiceOptions options;
  options.border = 45;
  options.spacing = 10;
  std::vector<Eigen::Vector2f> pixels;
  for (const ChosenPoint& point : choosePoints(grey, detectEdges(grey, {}), {}, options)) pixels.push_back(point.pixel);
  return pixels;
}

// Turned by `roll` and scaled about the image's centre: most points must find themselves.
TEST(KeyframeMatching, TurnedAndScaledImages) {
  const cv::Mat grey = test::renderRoom(3, test::placeCamera(), {});
  const std::vector<Eigen::Vector2f> pixels = edgePixels(grey);
  ASSERT_GT(pixels.size(), 40u);
  for (const double roll : {0.0, 0.6, -1.2}) {
    for (const double scale : {1.0, 0.7}) {
      const Eigen::Vector2f centre(159.5f, 119.5f);
      const Eigen::Matrix2f turn =
          static_cast<float>(scale) * Eigen::Rotation2Df(static_cast<float>(roll)).toRotationMatrix();
      const cv::Matx23f affine(turn(0, 0), turn(0, 1), centre.x() - (turn * centre).x(),  //
                               turn(1, 0), turn(1, 1), centre.y() - (turn * centre).y());
      cv::Mat turned;
      cv::warpAffine(grey, turned, affine, grey.size(), cv::INTER_LINEAR, cv::BORDER_REFLECT_101);
      std::vector<Eigen::Vector2f> there;
      for (const Eigen::Vector2f& pixel : pixels) there.emplace_back(turn * (pixel - centre) + centre);
      const DescribedPoints first = describePoints(turned, there, roll), second = describePoints(grey, pixels, 0);
      int right = 0, all = 0;
      for (const auto& [i, j] : matchDescriptors(first, second, {})) {
        ++all;
        const auto a = static_cast<std::size_t>(first.points[static_cast<std::size_t>(i)]);
        const auto b = static_cast<std::size_t>(second.points[static_cast<std::size_t>(j)]);
        if ((pixels[a] - pixels[b]).norm() < 12) ++right;
      }
      EXPECT_GT(right, 0.25 * static_cast<double>(first.points.size())) << "roll " << roll << ", scale " << scale;
      EXPECT_GT(right, 0.85 * all) << "roll " << roll << ", scale " << scale;
    }
  }
}

TEST(KeyframeMatching, OtherImagesHardlyMatch) {
  const cv::Mat a = test::renderRoom(3, test::placeCamera(), {}), b = test::renderRoom(4, test::placeCamera(), {});
  const DescribedPoints in_a = describePoints(a, edgePixels(a), 0), in_b = describePoints(b, edgePixels(b), 0);
  EXPECT_LT(matchDescriptors(in_a, in_b, {}).size(), in_a.points.size() / 4);
}

TEST(KeyframeMatching, PointsTooNearTheBorderAreLeftOut) {
  const cv::Mat grey = test::renderRoom(3, test::placeCamera(), {});
  const DescribedPoints described = describePoints(grey, {{2, 2}, {160, 120}, {318, 100}}, 0);
  EXPECT_EQ(described.points, std::vector<int>{1});
  for (const cv::Mat& descriptors : described.descriptors) EXPECT_EQ(descriptors.rows, 1);
  EXPECT_TRUE(matchDescriptors(describePoints(grey, {}, 0), described, {}).empty());
  EXPECT_TRUE(matchDescriptors(described, describePoints(grey, {}, 0), {}).empty());
}

}  // namespace
}  // namespace edgeslam
