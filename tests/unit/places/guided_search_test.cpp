// P22, P26: each demand on a pose found by guided search refuses just beyond what speaks for the pose, and not short of
// it.
#include "places/guided_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <set>

#include "unit/geometry/degree.h"
#include "unit/places/made_place.h"

namespace edgeslam::test {
namespace {

// A room seen by three keyframes, and a frame from a little beside the middle one.
struct SeenRoom {
  Camera camera = placeCamera();
  Map map = makePlace(
      7, camera, {Pose(), Pose{rotationExp({0, 0.05, 0}), {0.1, 0, 0}}, Pose{rotationExp({0, 0.1, 0}), {0.2, 0, 0}}});
  Pose truth{rotationExp({0.02, 0.04, -0.03}), {0.12, 0.04, 0.1}};
  FrameImages images;
  EdgeMap edges;
  std::vector<PointId> points = pointsAround(map, 1, 6);

  SeenRoom() {
    const cv::Mat grey = renderRoom(7, camera, truth);
    images.pyramid = buildPyramid(grey, 4);
    edges = detectEdges(grey, {});
  }

  // From a start half a degree and a few hundredths off.
  GuidedSearchResult search(const GuidedSearchOptions& options) const {
    const Pose start{truth.rotation * rotationExp(Eigen::Vector3d(0.3, -0.5, 0.3) * degree),
                     truth.translation + Eigen::Vector3d(0.01, 0.01, -0.02)};
    return guidedSearch(camera, map, points, {images, edges, {}}, start, options);
  }
};

const SeenRoom& seenRoom() {
  static const SeenRoom seen;
  return seen;
}

// Nothing is asked for; what is asked of bare scenes only where `bare`.
GuidedSearchOptions noDemands(bool bare) {
  GuidedSearchOptions options;
  options.fewest_inliers = 0;
  options.inlier_share = options.corner_share = options.bare_inlier_share = options.bare_corner_share = 0;
  options.fewest_corners = 0;
  options.telling_corners = bare ? std::numeric_limits<int>::max() : 0;
  options.many_corners = std::numeric_limits<int>::max();
  options.explained_share = 0;
  options.fewest_cells = 0;
  options.position_sigma = options.rotation_sigma_deg = std::numeric_limits<double>::infinity();
  return options;
}

TEST(GuidedSearch, FindsThePoseAndWhatSpeaksForIt) {
  const GuidedSearchResult found = seenRoom().search({});
  ASSERT_TRUE(found.accepted) << found.reason;
  EXPECT_TRUE(found.reason.empty());
  EXPECT_LT((found.pose.world_T_camera.translation - seenRoom().truth.translation).norm(), 0.01);
  EXPECT_LT(rotationAngle(found.pose.world_T_camera.rotation, seenRoom().truth.rotation), 0.3 * degree);
  const PoseEvidence& evidence = found.evidence;
  EXPECT_EQ(static_cast<int>(found.inliers.size()), evidence.inliers);
  int corners = 0;
  for (const MatchedPoint& match : found.inliers) {
    corners += match.corner ? 1 : 0;
    const Eigen::Vector3d seen =
        seenRoom().truth.inverse() * worldPosition(seenRoom().map, seenRoom().map.points.at(match.point));
    const Eigen::Vector2d apart = project(seenRoom().camera, seen) - match.measurement.pixel;
    EXPECT_LT(std::abs(apart.dot(match.measurement.normal)), 2.5) << match.point;
  }
  EXPECT_EQ(corners, evidence.corner_inliers);
  EXPECT_LE(evidence.inliers, evidence.visible);
  EXPECT_LE(evidence.corner_inliers, evidence.visible_corners);
  EXPECT_LE(evidence.visible, GuidedSearchOptions().searched_points);
  EXPECT_NEAR(evidence.share(), static_cast<double>(evidence.inliers) / evidence.visible, 1e-12);
  EXPECT_GT(evidence.median_distance, 2);
  EXPECT_LT(evidence.median_distance, 4);
  EXPECT_GT(evidence.cells, 10);
  EXPECT_LE(evidence.cells, 16);
}

// The stated deviations are those of the pose: the error is within four of them, and they are not idle.
TEST(GuidedSearch, ItsDeviationsAreThoseOfThePose) {
  const GuidedSearchResult found = seenRoom().search({});
  ASSERT_TRUE(found.accepted);
  const double off = (found.pose.world_T_camera.translation - seenRoom().truth.translation).norm();
  EXPECT_LT(off, 4 * found.evidence.position_sigma * found.evidence.median_distance);
  EXPECT_GT(found.evidence.position_sigma, 1e-5);
  EXPECT_LT(found.evidence.position_sigma, 0.01);
  const Eigen::Vector3d turned(found.pose.covariance.diagonal().tail<3>());
  EXPECT_GE(found.evidence.rotation_sigma_deg * degree, std::sqrt(turned.maxCoeff()) * (1 - 1e-9));
  EXPECT_LE(found.evidence.rotation_sigma_deg * degree, std::sqrt(turned.sum()) * (1 + 1e-9));
  const Eigen::Vector3d moved(found.pose.covariance.diagonal().head<3>());
  const double position_sigma = found.evidence.position_sigma * found.evidence.median_distance;
  EXPECT_GE(position_sigma, std::sqrt(moved.maxCoeff()) * (1 - 1e-9));
  EXPECT_LE(position_sigma, std::sqrt(moved.sum()) * (1 + 1e-9));
}

TEST(GuidedSearch, EachDemandRefusesJustBeyondWhatSpeaksForThePose) {
  const PoseEvidence evidence = seenRoom().search(noDemands(false)).evidence;
  ASSERT_GT(evidence.corner_inliers, 0);
  const double inlier_share = evidence.share(),
               corner_share = static_cast<double>(evidence.corner_inliers) / evidence.visible_corners;
  struct Demand {
    const char* name;
    bool bare;
    std::function<void(GuidedSearchOptions&, double)> ask;
    double met;
  };
  using O = GuidedSearchOptions;
  const Demand demands[] = {
      {"inlier share", false, [](O& o, double v) { o.inlier_share = v; }, inlier_share},
      {"corner share", false, [](O& o, double v) { o.corner_share = v; }, corner_share},
      {"bare inlier share", true, [](O& o, double v) { o.bare_inlier_share = v; }, inlier_share},
      {"bare corner share", true, [](O& o, double v) { o.bare_corner_share = v; }, corner_share},
      {"explained share", true, [](O& o, double v) { o.explained_share = v; }, evidence.explained},
      // These two must stay under their bounds.
      {"position", false, [](O& o, double v) { o.position_sigma = 1 / v; }, 1 / evidence.position_sigma},
      {"rotation", false, [](O& o, double v) { o.rotation_sigma_deg = 1 / v; }, 1 / evidence.rotation_sigma_deg},
  };
  for (const Demand& demand : demands) {
    GuidedSearchOptions options = noDemands(demand.bare);
    demand.ask(options, 0.999 * demand.met);
    EXPECT_TRUE(seenRoom().search(options).accepted) << demand.name;
    demand.ask(options, 1.001 * demand.met);
    const GuidedSearchResult refused = seenRoom().search(options);
    EXPECT_FALSE(refused.accepted) << demand.name;
    EXPECT_FALSE(refused.reason.empty()) << demand.name;
    if (!demand.bare) continue;
    options.telling_corners = evidence.corner_inliers;  // so many tell the place: nothing more is asked
    EXPECT_TRUE(seenRoom().search(options).accepted) << demand.name;
    options.telling_corners = evidence.corner_inliers + 1;
    EXPECT_FALSE(seenRoom().search(options).accepted) << demand.name;
  }
}

// Bare or not.
TEST(GuidedSearch, ManyCornersMakeUpForPointsThatAreNotFound) {
  const PoseEvidence evidence = seenRoom().search(noDemands(false)).evidence;
  ASSERT_GT(evidence.corner_inliers, 0);
  for (const bool bare : {false, true}) {
    GuidedSearchOptions options = noDemands(bare);
    options.inlier_share = options.bare_inlier_share = 1.001 * evidence.share();
    options.explained_share = bare ? 1.01 : 0;
    options.many_corners_inlier_share = 0.999 * evidence.share();
    options.many_corners_share = 0.999 * evidence.corner_inliers / evidence.visible_corners;
    options.many_corners = evidence.corner_inliers + 1;
    EXPECT_FALSE(seenRoom().search(options).accepted) << bare;
    options.many_corners = evidence.corner_inliers;
    EXPECT_TRUE(seenRoom().search(options).accepted) << bare;
    GuidedSearchOptions more = options;
    more.many_corners_inlier_share = 1.001 * evidence.share();
    EXPECT_FALSE(seenRoom().search(more).accepted) << bare;
    more = options;
    more.many_corners_share = 1.001 * evidence.corner_inliers / evidence.visible_corners;
    EXPECT_FALSE(seenRoom().search(more).accepted) << bare;
  }
}

TEST(GuidedSearch, EachCountRefusesOneBeyondWhatSpeaksForThePose) {
  const PoseEvidence evidence = seenRoom().search(noDemands(false)).evidence;
  GuidedSearchOptions options = noDemands(false);
  options.fewest_inliers = evidence.inliers;
  EXPECT_TRUE(seenRoom().search(options).accepted);
  options.fewest_inliers = evidence.inliers + 1;
  EXPECT_FALSE(seenRoom().search(options).accepted);
  options = noDemands(false);
  options.fewest_cells = evidence.cells;
  EXPECT_TRUE(seenRoom().search(options).accepted);
  options.fewest_cells = evidence.cells + 1;
  EXPECT_FALSE(seenRoom().search(options).accepted);
  // Of few corners nothing is asked.
  options = noDemands(false);
  options.corner_share = 1.01;
  options.fewest_corners = evidence.visible_corners;
  EXPECT_FALSE(seenRoom().search(options).accepted);
  options.fewest_corners = evidence.visible_corners + 1;
  EXPECT_TRUE(seenRoom().search(options).accepted);
}

TEST(GuidedSearch, LooksForNoMorePointsThanItMayHalfOfThemCorners) {
  GuidedSearchOptions options = noDemands(false);
  options.searched_points = 100000;
  const PoseEvidence all = seenRoom().search(options).evidence;
  ASSERT_GT(all.visible_corners, 12);
  ASSERT_GT(all.visible - all.visible_corners, 12);
  options.searched_points = all.visible + 20;  // as the pose may see a few more
  EXPECT_EQ(seenRoom().search(options).evidence.visible, all.visible);
  EXPECT_EQ(seenRoom().search(options).evidence.visible_corners, all.visible_corners);
  options.searched_points = 24;
  const GuidedSearchResult few = seenRoom().search(options);
  EXPECT_TRUE(few.accepted);
  EXPECT_EQ(few.evidence.visible, 24);
  EXPECT_EQ(few.evidence.visible_corners, 12);
  EXPECT_GT(few.evidence.cells, 5) << "from all over the image";
}

TEST(GuidedSearch, ThePointsAroundAKeyframeAreItsOwnAndThoseOfItsBestNeighbours) {
  std::vector<Pose> poses;
  for (int k = 0; k < 5; ++k) poses.push_back({rotationExp({0, 0.25 * k, 0}), {0.2 * k, 0, 0}});
  const Map map = makePlace(7, placeCamera(), poses);
  constexpr KeyframeId centre = 2;
  const std::vector<int> shared = sharedPoints(map, centre);
  std::vector<KeyframeId> order{1, 3, 0, 4};
  std::stable_sort(order.begin(), order.end(), [&](KeyframeId a, KeyframeId b) {
    return shared[static_cast<std::size_t>(a)] > shared[static_cast<std::size_t>(b)];
  });
  order.insert(order.begin(), centre);
  std::set<PointId> expected;
  for (int neighbours = 0; neighbours < 3; ++neighbours) {
    const std::size_t fewer = expected.size();
    for (const PointObservation& seen : map.keyframes[order[static_cast<std::size_t>(neighbours)]].observations) {
      if (map.points.count(seen.point) > 0) expected.insert(seen.point);
    }
    EXPECT_GT(expected.size(), fewer);
    EXPECT_EQ(pointsAround(map, centre, neighbours), std::vector<PointId>(expected.begin(), expected.end()));
  }
}

TEST(GuidedSearch, AnotherRoomGivesNoPoseThatIsAccepted) {
  const cv::Mat grey = renderRoom(8, seenRoom().camera, seenRoom().truth);
  FrameImages images;
  images.pyramid = buildPyramid(grey, 4);
  const EdgeMap edges = detectEdges(grey, {});
  const GuidedSearchResult found =
      guidedSearch(seenRoom().camera, seenRoom().map, seenRoom().points, {images, edges, {}}, seenRoom().truth, {});
  EXPECT_FALSE(found.accepted);
  EXPECT_FALSE(found.reason.empty());
}

TEST(GuidedSearch, UnpacksTheImagesAloneByWhichItSearches) {
  const Camera camera = placeCamera();
  const Eigen::Quaterniond about(0, 0, 1, 0);  // where the last two look the frame does not
  const Map map = makePlace(
      7, camera,
      {Pose(), Pose{Eigen::Quaterniond::Identity(), {0.1, 0, 0}}, Pose{about, {0, 0, 0}}, Pose{about, {0.1, 0, 0}}});
  for (const Keyframe& keyframe : map.keyframes) keyframe.images.pack();
  const Pose truth{Eigen::Quaterniond::Identity(), {0.02, 0, 0}};
  FrameImages images;
  const cv::Mat grey = renderRoom(7, camera, truth);
  images.pyramid = buildPyramid(grey, 4);
  const EdgeMap edges = detectEdges(grey, {});
  std::vector<PointId> points;
  for (const auto& [id, point] : map.points) points.push_back(id);
  guidedSearch(camera, map, points, {images, edges, {}}, truth, {});
  EXPECT_TRUE(map.keyframes[0].images.pack()) << "they were looked at";
  for (const KeyframeId away : {2, 3}) EXPECT_FALSE(map.keyframes[away].images.pack()) << "they are packed still";
}

// Of the keyframes that saw a point, the one that saw it most nearly from here.
TEST(GuidedSearch, SearchesByThePatchOfTheNearestKeyframe) {
  for (const KeyframeId near : {0, 1, 2}) {
    std::vector<KeyframeId> sources;
    const Pose& pose = seenRoom().map.keyframes[near].world_T_camera;
    const SearchPoints points = searchPoints(seenRoom().map, seenRoom().points, pose, sources);
    ASSERT_EQ(points.size(), sources.size());
    ASSERT_GT(points.size(), 100U);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const bool seen_there = findObservation(seenRoom().map.keyframes[near], points[i].id) != nullptr;
      EXPECT_EQ(sources[i] == near, seen_there) << points[i].id;
      const PointObservation* seen = findObservation(seenRoom().map.keyframes[sources[i]], points[i].id);
      ASSERT_NE(seen, nullptr);
      EXPECT_EQ(points[i].source_pixel, Eigen::Vector2f(seen->measurement.pixel.cast<float>()));
    }
  }
}

}  // namespace
}  // namespace edgeslam::test
