// Map points are found again in a rendered room, from a pose that is a little wrong.
#include "tracking/map_search.h"

#include <gtest/gtest.h>

#include <set>

#include "unit/geometry/degree.h"
#include "unit/places/made_place.h"
#include "unit/tracking/textured_plane.h"

namespace edgeslam::test {
namespace {

FoundPoints search(const SearchPoints& points, const FrameImages& images, const EdgeMap& edges, const Pose& pose) {
  return findVisiblePoints(points, visiblePoints(placeCamera(), points, pose, {}), images, edges, {});
}

struct Searched {
  std::shared_ptr<const FrameImages> images;  // of the first keyframe
  Map map;
  SearchPoints points;
};

// The points of the first keyframe, by its patches.
const Searched& room() {
  static const Searched searched = [] {
    Searched result;
    result.map = makePlace(7, placeCamera(), {Pose(), Pose{rotationExp({0, 0.05, 0}), {0.1, 0, 0}}});
    const Keyframe& source = result.map.keyframes.front();
    result.images = source.images.get();
    for (const auto& [id, point] : result.map.points) {
      const PointObservation* seen = findObservation(source, id);
      if (!seen) continue;
      const Measurement& m = seen->measurement;
      result.points.push_back({id, worldPosition(result.map, point), result.images.get(), source.world_T_camera,
                               m.pixel.cast<float>(), m.normal.cast<float>(), seen->corner,
                               static_cast<float>(m.sigma_normal), static_cast<float>(m.sigma_tangent)});
    }
    return result;
  }();
  return searched;
}

struct Found {
  std::size_t visible = 0;
  std::size_t found = 0;
  std::size_t right = 0;  // across the edge within half a pixel
};

Found searchFrom(const Pose& truth, const Pose& guess, std::uint64_t seed = 7) {
  const cv::Mat grey = renderRoom(seed, placeCamera(), truth);
  const EdgeMap edges = detectEdges(grey, {});
  const std::shared_ptr<const FrameImages> images = imagesOf(grey);
  Found result;
  result.visible = visiblePoints(placeCamera(), room().points, guess, {}).size();
  for (const FoundPoint& found : search(room().points, *images, edges, guess)) {
    const Eigen::Vector3d seen = truth.inverse() * room().points[found.index].position;
    const Eigen::Vector2f apart = found.pixel - project(placeCamera(), seen).cast<float>();
    ++result.found;
    result.right += std::abs(apart.dot(found.normal)) < 0.5f ? 1 : 0;
    EXPECT_GE(found.correlation, 0.8f);
    EXPECT_NEAR(found.normal.norm(), 1, 1e-4);
  }
  return result;
}

TEST(MapSearch, FindsItsOwnPointsInItsOwnImage) {
  const Found found = searchFrom(Pose(), Pose());
  ASSERT_GT(found.visible, 100U);
  EXPECT_GT(found.found, 0.95 * static_cast<double>(found.visible));
  EXPECT_GT(found.right, 0.98 * static_cast<double>(found.found));
}

TEST(MapSearch, FindsThemFromElsewhereWithAPoseThatIsALittleWrong) {
  const Pose truth{rotationExp(Eigen::Vector3d(1, -3, 5) * degree), {0.15, -0.05, 0.2}};
  const Pose guess{truth.rotation * rotationExp(Eigen::Vector3d(0.5, -0.6, 0.3) * degree),
                   truth.translation + Eigen::Vector3d(0.01, 0, -0.02)};
  const Found found = searchFrom(truth, guess);
  ASSERT_GT(found.visible, 100U);
  EXPECT_GT(found.found, 0.75 * static_cast<double>(found.visible));
  EXPECT_GT(found.right, 0.9 * static_cast<double>(found.found));
}

TEST(MapSearch, FindsLittleWhereNothingOfItIs) {
  const Found found = searchFrom(Pose(), Pose(), /*seed=*/8);
  EXPECT_LT(found.found, 0.3 * static_cast<double>(found.visible));
}

TEST(MapSearch, BehindBesideAndFromTheOtherSideNothingIsVisible) {
  const auto visibleFrom = [](const Pose& pose) {
    return visiblePoints(placeCamera(), room().points, pose, {}).size();
  };
  EXPECT_EQ(visibleFrom({rotationExp({0, M_PI, 0}), Eigen::Vector3d::Zero()}), 0U);
  EXPECT_EQ(visibleFrom({rotationExp({0, M_PI, 0}), {0, 0, 8}}), 0U) << "through the wall, from behind";
  EXPECT_EQ(visibleFrom({Eigen::Quaterniond::Identity(), {0, 0, -12}}), 0U) << "four times as far";
}

TEST(MapSearch, NormalsTurnWithTheImage) {
  const double roll = 20 * degree;
  const Pose rolled{rotationExp({0, 0, roll}), Eigen::Vector3d::Zero()};
  const Eigen::Matrix2f turn = Eigen::Rotation2Df(static_cast<float>(-roll)).toRotationMatrix();
  const VisiblePoints visible = visiblePoints(placeCamera(), room().points, rolled, {});
  ASSERT_GT(visible.size(), 100U);
  for (const VisiblePoint& point : visible) {
    EXPECT_GT(point.normal.dot(turn * room().points[point.index].source_normal), 0.98f);
  }
}

TEST(MapSearch, EachPointOnceAndInOrder) {
  const cv::Mat grey = renderRoom(7, placeCamera(), Pose());
  const auto found = search(room().points, *imagesOf(grey), detectEdges(grey, {}), Pose());
  ASSERT_FALSE(found.empty());
  for (std::size_t i = 1; i < found.size(); ++i) EXPECT_LT(found[i - 1].index, found[i].index);
}

TEST(MapSearch, AnImageWithoutEdgesHasNone) {
  const cv::Mat grey(240, 320, CV_8U, cv::Scalar(120));
  EXPECT_TRUE(search(room().points, *imagesOf(grey), detectEdges(grey, {}), Pose()).empty());
}

}  // namespace
}  // namespace edgeslam::test
