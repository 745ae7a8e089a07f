// The motion between two frames from small patches around all tracks.
#include "tracking/sparse_alignment.h"

#include <gtest/gtest.h>

#include "unit/tracking/textured_plane.h"

namespace edgeslam {
namespace {

struct TwoViews {
  Camera camera = smallCamera();
  ImagePyramid from, to;
  AlignmentPoints points;
  Pose to_T_from;
};

TwoViews viewsAfter(const Pose& world_T_second) {
  TwoViews views;
  TexturedPlane plane{SmoothTexture(52)};
  plane.grain = 2;
  views.from = buildPyramid(plane.render(views.camera, Pose()), 6);
  views.to = buildPyramid(plane.render(views.camera, world_T_second), 6);
  for (int y = 30; y < 220; y += 18) {
    for (int x = 30; x < 300; x += 18) {
      const Eigen::Vector2f pixel(static_cast<float>(x), static_cast<float>(y));
      views.points.push_back({pixel, plane.seenAt(views.camera, Pose(), pixel.cast<double>())});
    }
  }
  views.to_T_from = world_T_second.inverse();
  return views;
}

// Largest distance [px] between where the points are and where an estimate puts them.
double largestError(const TwoViews& views, const Pose& to_T_from) {
  double largest = 0;
  for (const AlignmentPoint& point : views.points) {
    largest = std::max(largest, (project(views.camera, to_T_from * point.position) -
                                 project(views.camera, views.to_T_from * point.position))
                                    .norm());
  }
  return largest;
}

TEST(SparseAlignment, FindsMotionInAllSixDirections) {
  for (int axis = 0; axis < 6; ++axis) {
    Vector6d motion = Vector6d::Zero();
    motion[axis] = axis < 3 ? 0.04 : 0.02;
    const TwoViews views = viewsAfter(retract(Pose(), motion));
    const Pose found = alignSparsely(views.camera, views.from, views.to, views.points, Pose(), Pose(), {});
    EXPECT_LT(largestError(views, found), 1.0) << "axis " << axis << ", from " << largestError(views, Pose());
  }
}

TEST(SparseAlignment, TakesTheBetterOfTwoStarts) {
  Vector6d motion;
  motion << 0.35, -0.1, 0.05, 0.02, 0.15, -0.03;  // much too far for a start from rest
  const TwoViews views = viewsAfter(retract(Pose(), motion));
  const auto errorFrom = [&](const Pose& second_start) {
    return largestError(views,
                        alignSparsely(views.camera, views.from, views.to, views.points, Pose(), second_start, {}));
  };
  EXPECT_GT(errorFrom(Pose()), 10.0) << "the case is no test of the starts";
  EXPECT_LT(errorFrom(views.to_T_from), 2.0) << "patches are compared as they are, not warped";
}

TEST(SparseAlignment, WithTooFewPointsTheFirstStartStands) {
  TwoViews views = viewsAfter(Pose());
  views.points.resize(5);
  const Pose start = retract(Pose(), Vector6d::Constant(0.01));
  const Pose found = alignSparsely(views.camera, views.from, views.to, views.points, start, Pose(), {});
  EXPECT_EQ(found.translation, start.translation);
  EXPECT_EQ(found.rotation.coeffs(), start.rotation.coeffs());
}

// A plate of the robot stays where it is; patches at its border see it in the coarse images.
TEST(SparseAlignment, PatchesThatSeeWhatIsMaskedDoNotCount) {
  TwoViews views = viewsAfter({Eigen::Quaterniond::Identity(), {0.06, 0, 0}});
  cv::Mat masked(views.camera.height, views.camera.width, CV_8U, cv::Scalar(0));
  masked.colRange(0, 150).setTo(255);
  const cv::Mat plate =
      SmoothTexture(9).render({150, views.camera.height}, [](const Eigen::Vector2d& p) { return p / 4; });
  for (ImagePyramid* pyramid : {&views.from, &views.to}) {
    cv::Mat image = pyramid->levels[0].clone();
    plate.copyTo(image.colRange(0, 150));
    *pyramid = buildPyramid(image, 6);
  }
  const auto error = [&](const HiddenLevels& hidden) {
    return largestError(views, alignSparsely(views.camera, views.from, views.to, views.points, Pose(), Pose(), {},
                                             std::pmr::get_default_resource(), hidden));
  };
  EXPECT_GT(error({}), 3) << "the case is no test of the mask";
  EXPECT_LT(error(hiddenLevels(masked, 5, alignment_reach)), 1);
}

}  // namespace
}  // namespace edgeslam
