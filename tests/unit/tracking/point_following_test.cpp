// P5, P6: tracks are found again in the next frame, and those that fail are dropped.
#include "tracking/point_following.h"

#include <gtest/gtest.h>

#include "unit/edges/synthetic_image.h"
#include "unit/tracking/textured_plane.h"

namespace edgeslam {
namespace {

Pixels predicted(const Camera& camera, const std::vector<Track>& tracks, const MapView& view, const Pose& last,
                 const Pose& next, double scene_depth) {
  return predictPixels(camera, placeTracks(camera, tracks, view, last, scene_depth), last, next);
}

TEST(PointFollowing, PlacesTracksOnTheirRays) {
  const Camera camera = smallCamera();
  MapView view;
  view.keyframes = {{0, Pose(), nullptr}};
  const Pose last{rotationExp({0.01, 0.02, 0}), {0.1, 0, 0}};
  const Eigen::Vector3d point(0.2, -0.1, 2.5);
  view.points = {viewPoint(view, 1, 0, point)};
  const Eigen::Vector2f seen = project(camera, last.inverse() * point).cast<float>();
  const AlignmentPoints placed = placeTracks(camera, {trackAt(0, seen), trackAt(1, seen)}, view, last, 4.0);
  ASSERT_EQ(placed.size(), 2u);
  EXPECT_NEAR(placed[0].position.norm(), 4, 1e-9) << "has no map point";
  EXPECT_LT((placed[1].position - last.inverse() * point).norm(), 1e-3);
  EXPECT_EQ(placed[1].pixel, seen);
}

TEST(PointFollowing, PredictsWhereAMapPointIsSeenNext) {
  const Camera camera = smallCamera();
  MapView view;
  view.keyframes = {{0, Pose(), nullptr}};
  const Pose last{rotationExp({0.01, 0.02, 0}), {0.1, 0, 0}}, next{rotationExp({0, -0.03, 0.02}), {0.25, -0.05, 0.1}};
  std::vector<Track> tracks;
  std::vector<Eigen::Vector2f> expected;
  for (int i = 0; i < 5; ++i) {
    const Eigen::Vector3d point(0.3 * i - 0.5, 0.1 * i - 0.2, 1.5 + 0.4 * i);
    view.points.push_back(viewPoint(view, i, 0, point));
    tracks.push_back(trackAt(i, project(camera, last.inverse() * point).cast<float>()));
    expected.emplace_back(project(camera, next.inverse() * point).cast<float>());
  }
  const Pixels seen_next = predicted(camera, tracks, view, last, next, 1.0);
  ASSERT_EQ(seen_next.size(), tracks.size());
  for (std::size_t i = 0; i < tracks.size(); ++i) EXPECT_LT((seen_next[i] - expected[i]).norm(), 0.01f) << i;
}

// The pixel goes on from where it was seen, even where the map point projects elsewhere.
TEST(PointFollowing, PredictsThePointsMotionNotItsPlace) {
  const Camera camera = smallCamera();
  MapView view;
  view.keyframes = {{0, Pose(), nullptr}};
  view.points = {viewPoint(view, 0, 0, {0.1, 0.1, 2})};
  const Eigen::Vector2f seen = project(camera, {0.1, 0.1, 2}).cast<float>() + Eigen::Vector2f(3, -2);
  EXPECT_LT((predicted(camera, {trackAt(0, seen)}, view, Pose(), Pose(), 1.0)[0] - seen).norm(), 1e-3f);
}

TEST(PointFollowing, PredictsATrackWithoutDepthAtTheScenesDepth) {
  const Camera camera = smallCamera();
  MapView view;
  view.keyframes = {{0, Pose(), nullptr}};
  const Eigen::Vector3d point = 3.5 * Eigen::Vector3d(0.1, -0.2, 1).normalized();
  const Pose next{Eigen::Quaterniond::Identity(), {0.2, 0, 0}};
  const std::vector<Track> tracks{trackAt(3, project(camera, point).cast<float>())};
  const Eigen::Vector2f expected = project(camera, next.inverse() * point).cast<float>();
  EXPECT_LT((predicted(camera, tracks, view, Pose(), next, 3.5)[0] - expected).norm(), 0.01f);
  EXPECT_GT((predicted(camera, tracks, view, Pose(), next, 7.0)[0] - expected).norm(), 1.0f);
}

TEST(PointFollowing, APointThatWouldBeBehindTheCameraIsPredictedWhereItIs) {
  const Camera camera = smallCamera();
  MapView view;
  view.keyframes = {{0, Pose(), nullptr}};
  const Eigen::Vector2f pixel(100, 80);
  const Pose beyond{Eigen::Quaterniond::Identity(), {0, 0, 5}};
  EXPECT_EQ(predicted(camera, {trackAt(0, pixel)}, view, Pose(), beyond, 2.0)[0], pixel);
}

TEST(PointFollowing, MedianDepthIsOfTheMapPointsAmongTheTracks) {
  MapView view;
  view.keyframes = {{0, Pose(), nullptr}};
  for (int i = 0; i < 5; ++i) view.points.push_back(viewPoint(view, i, 0, {0, 0, 1.0 + i}));
  std::vector<Track> tracks;
  for (const PointId id : {0, 1, 4, 9}) tracks.push_back(trackAt(id, {50, 50}));
  EXPECT_NEAR(medianDepth(tracks, view, Pose(), 7), 2, 1e-9);
  EXPECT_NEAR(medianDepth(tracks, view, {Eigen::Quaterniond::Identity(), {0, 0, -1}}, 7), 3, 1e-9);
  EXPECT_EQ(medianDepth({trackAt(9, {50, 50})}, view, Pose(), 7), 7);
  EXPECT_EQ(medianDepth({}, view, Pose(), 7), 7);
}

TEST(PointFollowing, MedianDepthDoesNotDependOnTheOrderOfThePoints) {
  for (int first = 0; first < 41; ++first) {
    MapView view;
    view.keyframes = {{0, Pose(), nullptr}};
    std::vector<Track> tracks;
    for (int i = 0; i < 41; ++i) {
      const int depth = 1 + (first + 17 * i) % 41;  // each of 1 to 41 once
      view.points.push_back(viewPoint(view, i, 0, {0, 0, 1.0 * depth}));
      tracks.push_back(trackAt(i, {50, 50}));
    }
    EXPECT_NEAR(medianDepth(tracks, view, Pose(), 7), 21, 1e-9) << first;
  }
}

// Each filter by itself: the others are open.
class TrackFilters : public ::testing::Test {
 protected:
  TrackFilters() {
    options_.redundancy = 0;
    options_.forward_backward = 1e9;
    options_.edge_distance = 1000;
  }

  static Line line(double moved) {
    Line line = lineThrough(160, 120, 20);
    line.offset += moved;
    return line;
  }
  static std::shared_ptr<const FrameImages> imagesWithLine(double moved) {
    return imagesOf(renderLine({320, 240}, line(moved)));
  }

  // A point of the line, `along` it from its middle.
  static Eigen::Vector2f onLine(double along, double moved = 0) {
    const Eigen::Vector2d n = line(0).normal;
    return (Eigen::Vector2d(160, 120) + moved * n + along * Eigen::Vector2d(-n.y(), n.x())).cast<float>();
  }
  static Track onLineTrack(PointId id, double along) {
    return trackAt(id, onLine(along), line(0).normal.cast<float>());
  }

  static FlowMatch matchAt(const Eigen::Vector2f& pixel, bool found = true) {
    FlowMatch match;
    match.found = found;
    match.pixel = pixel;
    return match;
  }

  std::vector<Track> filtered(const std::vector<Track>& tracks, const FlowMatches& matches) const {
    std::vector<Track> kept;
    filterTracks(*from_, *to_, edges_, tracks, matches, options_, kept);
    return kept;
  }

  std::shared_ptr<const FrameImages> from_ = imagesWithLine(0), to_ = imagesWithLine(5);
  EdgeMap edges_ = detectEdges(to_->pyramid.levels[0], EdgeOptions());
  FlowOptions options_;
};

TEST_F(TrackFilters, WhatWasFoundMovesAndKeepsAllElse) {
  Track track = onLineTrack(4, 30);
  track.chain = 3;
  track.outlier_frames = 2;
  const std::vector<Track> kept = filtered({track}, {matchAt(onLine(30, 5))});
  ASSERT_EQ(kept.size(), 1U);
  EXPECT_EQ(kept[0].pixel, onLine(30, 5));
  EXPECT_EQ(kept[0].keyframe_pixel, onLine(30));
  EXPECT_EQ(kept[0].id, 4);
  EXPECT_EQ(kept[0].chain, 3);
  EXPECT_EQ(kept[0].outlier_frames, 2);
}

TEST_F(TrackFilters, WhatWasNotFoundGoes) {
  EXPECT_TRUE(filtered({onLineTrack(0, 0)}, {matchAt(onLine(0, 5), false)}).empty());
}

TEST_F(TrackFilters, WhatLeftTheImageGoes) {
  for (const Eigen::Vector2f& pixel : {Eigen::Vector2f(3, 120), {317, 120}, {160, 4}, {160, 236}, {-20, 500}}) {
    EXPECT_TRUE(filtered({onLineTrack(0, 0)}, {matchAt(pixel)}).empty()) << pixel.transpose();
  }
}

TEST_F(TrackFilters, OfTwoThatMeetTheOlderStays) {
  options_.redundancy = 1.5;
  const std::vector<Track> tracks{onLineTrack(1, 0), onLineTrack(2, 9), onLineTrack(5, 20)};
  const std::vector<Track> kept =
      filtered(tracks, {matchAt(onLine(5, 5)), matchAt(onLine(6.4, 5)), matchAt(onLine(20, 5))});
  ASSERT_EQ(kept.size(), 2U);
  EXPECT_EQ(kept[0].id, 1);
  EXPECT_EQ(kept[1].id, 5);
  EXPECT_EQ(filtered(tracks, {matchAt(onLine(5, 5)), matchAt(onLine(6.6, 5)), matchAt(onLine(20, 5))}).size(), 3U);
}

TEST_F(TrackFilters, WhatDoesNotComeBackAcrossItsEdgeGoes) {
  options_.forward_backward = 1.0;
  const Eigen::Vector2f wrong = onLine(0, 5) + 3 * line(0).normal.cast<float>();
  EXPECT_TRUE(filtered({onLineTrack(0, 0)}, {matchAt(wrong)}).empty());
  EXPECT_EQ(filtered({onLineTrack(0, 0)}, {matchAt(onLine(0, 5))}).size(), 1U);
  // Along a straight edge nothing can be told.
  EXPECT_EQ(filtered({onLineTrack(0, 0)}, {matchAt(onLine(3, 5))}).size(), 1U);
  options_.forward_backward = 1e9;
  EXPECT_EQ(filtered({onLineTrack(0, 0)}, {matchAt(wrong)}).size(), 1U);
}

TEST_F(TrackFilters, WhatIsOffTheEdgesGoes) {
  options_.edge_distance = 1.5;
  const Eigen::Vector2f normal = line(0).normal.cast<float>();
  EXPECT_EQ(filtered({onLineTrack(0, 0)}, {matchAt(onLine(0, 5) + 1.0f * normal)}).size(), 1U);
  EXPECT_TRUE(filtered({onLineTrack(0, 0)}, {matchAt(onLine(0, 5) + 3.0f * normal)}).empty());
  edges_ = detectEdges(cv::Mat(240, 320, CV_8U, cv::Scalar(90)), EdgeOptions());
  EXPECT_TRUE(filtered({onLineTrack(0, 0)}, {matchAt(onLine(0, 5))}).empty());
}

TEST_F(TrackFilters, AnEdgeOfAnotherDirectionIsAnotherEdgeExceptForACorner) {
  options_.edge_distance = 1.5;
  Track track = onLineTrack(0, 0);
  track.normal = -track.normal;
  EXPECT_TRUE(filtered({track}, {matchAt(onLine(0, 5))}).empty());
  track.corner = true;
  EXPECT_EQ(filtered({track}, {matchAt(onLine(0, 5))}).size(), 1U);
}

TEST(PointFollowing, FollowsAPlaneFromOnePoseToTheNext) {
  const Camera camera = smallCamera();
  const TexturedPlane plane{SmoothTexture(31, 12, 60)};
  const Pose next{rotationExp({0.01, 0.015, 0.02}), {0.03, -0.02, 0.02}};
  const auto from = imagesOf(plane.render(camera, Pose())), to = imagesOf(plane.render(camera, next));
  std::vector<Track> tracks;
  Pixels expected, predictions;
  for (float y = 30; y < 210; y += 15) {
    for (float x = 30; x < 290; x += 15) {
      tracks.push_back(trackAt(static_cast<PointId>(tracks.size()), {x, y}));
      const Eigen::Vector3d point = plane.seenAt(camera, Pose(), Eigen::Vector2d(x, y));
      expected.emplace_back(project(camera, next.inverse() * point).cast<float>());
      predictions.emplace_back(expected.back() + Eigen::Vector2f(0.6f, -0.5f));
    }
  }
  const auto matches = followPoints(*from, *to, tracks, predictions, FlowOptions());
  ASSERT_EQ(matches.size(), tracks.size());
  std::size_t good = 0;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    good += matches[i].found && (matches[i].pixel - expected[i]).norm() < 0.15f;
  }
  EXPECT_GT(good, 0.8 * static_cast<double>(matches.size()));
}

// Below what is masked, the windows of the coarse levels see it; those farther away never do.
TEST(PointFollowing, TheLevelsThatSeeWhatIsMaskedAreLeftOut) {
  const Camera camera = smallCamera();
  const TexturedPlane plane{SmoothTexture(31, 12, 60)};
  const auto from = imagesOf(plane.render(camera, Pose()));
  const auto to = imagesOf(plane.render(camera, {Eigen::Quaterniond::Identity(), {0.03, 0, 0}}));
  cv::Mat masked(camera.height, camera.width, CV_8U, cv::Scalar(0));
  masked.rowRange(0, 60).setTo(255);
  const std::vector<Track> tracks{trackAt(0, {160, 70}), trackAt(1, {160, 200})};
  const Pixels predictions{{157, 70}, {157, 200}};
  const FlowOptions options;
  const HiddenLevels hidden = hiddenLevels(masked, options.levels, flowReach(options));
  const auto matches = followPoints(*from, *to, tracks, predictions, options, std::pmr::get_default_resource(), hidden);
  FlowOptions finest = options;
  finest.levels = 1;
  EXPECT_EQ(matches[0].pixel, followPoint(from->pyramid, to->pyramid, {160, 70}, {157, 70}, finest).pixel);
  EXPECT_NE(matches[0].pixel, followPoint(from->pyramid, to->pyramid, {160, 70}, {157, 70}, options).pixel);
  EXPECT_EQ(matches[1].pixel, followPoint(from->pyramid, to->pyramid, {160, 200}, {157, 200}, options).pixel);
}

}  // namespace
}  // namespace edgeslam
