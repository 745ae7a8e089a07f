// P13, P14, P15: the start of the map, and scenes and motions that give none.
#include "mapping/initialisation.h"

#include <gtest/gtest.h>

#include <functional>
#include <map>

#include "geometry/similarity.h"
#include "tracking/pose_estimation.h"
#include "unit/mapping/edge_scene.h"

namespace edgeslam {
namespace {

using Path = std::function<Pose(int)>;
// Measured pixels of frame `index` in place of those that a camera at the pose would see.
using Spoil = std::function<void(int index, std::vector<PointObservation>&, test::Random&)>;

struct Start {
  Initialisation initialisation{test::distorted_camera, InitialisationOptions()};
  int accepted_at = -1;  // frame, or -1
  std::vector<PointId> first_points;
};

// As tracking does: each frame's pose against the provisional, at first flat, map.
Start run(
    const test::EdgeScene& scene, const Path& path, int frames, std::uint64_t seed,
    const Spoil& spoil = [](int, std::vector<PointObservation>&, test::Random&) {}) {
  test::Random random(seed);
  const test::Sight sight{0.6, 0.5};
  Start start;
  MapView view;
  Pose last;
  for (int i = 0; i < frames; ++i) {
    TrackedFrame frame;
    frame.frame_index = i;
    frame.time_ns = 33333333LL * i;
    frame.observations = test::observeAll(test::distorted_camera, scene, path(i), sight, random);
    spoil(i, frame.observations, random);
    if (i == 0) {
      frame.kind = FrameKind::first;
      frame.keyframe = 0;
      start.initialisation.start(frame);
      view = flatView(frame);
      for (const PointObservation& observation : frame.observations) start.first_points.push_back(observation.point);
      continue;
    }
    std::vector<Track> tracks;
    for (const PointObservation& observation : frame.observations) {
      Track track;
      track.id = observation.point;
      track.pixel = observation.measurement.pixel.cast<float>();
      track.normal = observation.measurement.normal.cast<float>();
      track.corner = observation.corner;
      track.sigma_normal = static_cast<float>(observation.measurement.sigma_normal);
      track.sigma_tangent = static_cast<float>(observation.measurement.sigma_tangent);
      tracks.push_back(track);
    }
    const FramePose pose = estimatePose(test::distorted_camera, view, tracks, last, FramePoseOptions());
    last = frame.world_T_camera = pose.result.world_T_camera;
    if (start.initialisation.add(frame)) {
      start.accepted_at = i;
      break;
    }
    if (start.initialisation.changed()) start.initialisation.writeProvisional(view);
  }
  return start;
}

Pose still(int) { return {}; }
Pose sideways(int i) { return {rotationExp({0.0008 * i, -0.001 * i, 0.001 * i}), {0.012 * i, 0.003 * i, 0.002 * i}}; }
Pose turning(int i) { return {rotationExp({0.001 * i, 0.004 * i, 0.002 * i}), {0, 0, 0}}; }

TEST(Initialisation, MotionSidewaysGivesTheRightMap) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const test::EdgeScene scene = test::framesOnAWall(seed + 20);
    const Start start = run(scene, sideways, 90, seed);
    ASSERT_GT(start.accepted_at, 0) << start.initialisation.waitingFor();
    EXPECT_EQ(start.initialisation.waitingFor(), "");
    EXPECT_NE(start.initialisation.description(), "");
    const Map map = start.initialisation.map();
    ASSERT_GE(map.keyframes.size(), 3U);
    EXPECT_EQ(map.keyframes.back().frame_index, start.accepted_at);
    EXPECT_GT(map.points.size(), 100U);

    std::vector<Eigen::Vector3d> found, truth;
    for (const auto& [id, point] : map.points) {
      found.push_back(worldPosition(map, point));
      truth.push_back(scene.points[static_cast<std::size_t>(id)].position);
    }
    const Similarity similarity = alignHorn(found, truth);
    std::vector<double> errors;
    for (std::size_t i = 0; i < found.size(); ++i) errors.push_back((similarity * found[i] - truth[i]).norm());
    std::sort(errors.begin(), errors.end());
    EXPECT_LT(errors[errors.size() / 2], 0.1) << "of a scene 3 away, with depth of 2";

    // The way that the camera went, up to scale.
    const Pose end = map.keyframes.back().world_T_camera, true_end = sideways(start.accepted_at);
    EXPECT_LT(rotationAngle(end.rotation, true_end.rotation), 0.015);
    EXPECT_GT(end.translation.normalized().dot(true_end.translation.normalized()), 0.97);
  }
}

TEST(Initialisation, TheMapIsWhole) {
  const Start start = run(test::framesOnAWall(21), sideways, 90, 1);
  ASSERT_GT(start.accepted_at, 0);
  const Map map = start.initialisation.map();
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) EXPECT_EQ(map.keyframes[k].id, static_cast<KeyframeId>(k));
  EXPECT_EQ(map.keyframes[0].frame_index, 0);
  EXPECT_EQ(map.keyframes[0].world_T_camera.translation, Eigen::Vector3d::Zero());
  EXPECT_EQ(map.keyframes[0].world_T_camera.rotation.coeffs(), Eigen::Quaterniond::Identity().coeffs());
  for (const auto& [id, point] : map.points) {
    EXPECT_EQ(point.id, id);
    EXPECT_GT(point.inverse_depth, 0);
    EXPECT_GT(point.inverse_depth_sigma, 0);
    EXPECT_NEAR(point.host_bearing.norm(), 1, 1e-9);
    ASSERT_FALSE(point.seen_in.empty());
    EXPECT_NE(findObservation(map.keyframes[point.host], id), nullptr);
    for (const KeyframeId k : point.seen_in) {
      EXPECT_NE(k, point.host);
      EXPECT_NE(findObservation(map.keyframes[k], id), nullptr);
    }
  }
}

// The start is corrected backwards: the frames before have poses, too.
TEST(Initialisation, TheFramesBeforeGetTheirPoses) {
  const Start start = run(test::framesOnAWall(22), sideways, 90, 2);
  ASSERT_GT(start.accepted_at, 0);
  const auto poses = start.initialisation.earlyPoses();
  ASSERT_EQ(poses.size(), static_cast<std::size_t>(start.accepted_at) + 1);
  std::vector<Eigen::Vector3d> found, truth;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(poses[i].first, static_cast<std::int64_t>(i));
    found.push_back(poses[i].second.translation);
    truth.push_back(sideways(static_cast<int>(i)).translation);
    EXPECT_LT(rotationAngle(poses[i].second.rotation, sideways(static_cast<int>(i)).rotation), 0.015) << i;
  }
  const double scale = truth.back().norm() / found.back().norm(), way = truth.back().norm();
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_LT((scale * found[i] - truth[i]).norm(), 0.25 * way) << i;
}

TEST(Initialisation, AnUnmovedCameraWaitsForParallax) {
  const Start start = run(test::framesOnAWall(23), still, 60, 3);
  EXPECT_EQ(start.accepted_at, -1);
  EXPECT_NE(start.initialisation.waitingFor().find("too little parallax"), std::string::npos)
      << start.initialisation.waitingFor();
}

TEST(Initialisation, RotationAloneIsNamedAndWaits) {
  for (const std::uint64_t seed : {4, 5}) {
    const Start start = run(test::framesOnAWall(24), turning, 60, seed);
    EXPECT_EQ(start.accepted_at, -1) << start.initialisation.description();
    EXPECT_NE(start.initialisation.waitingFor().find("rotation"), std::string::npos)
        << start.initialisation.waitingFor();
  }
}

TEST(Initialisation, RotationFirstAndMotionLaterStillStarts) {
  const auto path = [](int i) {
    return i < 30 ? turning(i) : Pose{turning(30).rotation, sideways(i - 30).translation};
  };
  const Start start = run(test::framesOnAWall(25), path, 150, 6);
  EXPECT_GT(start.accepted_at, 30) << start.initialisation.waitingFor();
}

// Points that go their own ways are no scene, whatever poses fit them best.
TEST(Initialisation, NoiseIsNeverTakenForAMap) {
  const test::EdgeScene scene = test::framesOnAWall(26);
  for (const std::uint64_t seed : {7, 8}) {
    test::Random ways(seed);
    std::vector<Eigen::Vector2d> drift;  // [px] a frame
    for (std::size_t i = 0; i < scene.points.size(); ++i) {
      const double angle = test::uniform(ways, 0, 2 * M_PI), speed = test::uniform(ways, 0.3, 1.5);
      drift.emplace_back(speed * std::cos(angle), speed * std::sin(angle));
    }
    int frames = 0;
    const auto drifting = [&](int index, std::vector<PointObservation>& observations, test::Random& random) {
      for (PointObservation& observation : observations) {
        Eigen::Vector2d& pixel = observation.measurement.pixel;
        pixel += index * drift[static_cast<std::size_t>(observation.point)];
        pixel += Eigen::Vector2d(test::uniform(random, -2, 2), test::uniform(random, -2, 2));
        observation.bearing = bearing(test::distorted_camera, pixel);
      }
      frames = index;
    };
    const Start start = run(scene, still, 22, seed, drifting);
    EXPECT_EQ(start.accepted_at, -1) << "seed " << seed << ": " << start.initialisation.description();
    EXPECT_EQ(frames, 21);
    EXPECT_NE(start.initialisation.waitingFor(), "");
  }
}

// The scene moves before a camera that stands, all but every fourth of its points, which are wherever they were.
TEST(Initialisation, AThingThatMovesBeforeAStandingCameraIsNoMap) {
  for (const std::uint64_t seed : {9, 10}) {
    std::map<PointId, Eigen::Vector2d> at_first;
    const auto background_stays = [&](int, std::vector<PointObservation>& observations, test::Random&) {
      for (PointObservation& observation : observations) {
        if (observation.point % 4 != 0) continue;
        Eigen::Vector2d& pixel = observation.measurement.pixel;
        pixel = at_first.try_emplace(observation.point, pixel).first->second;
        observation.bearing = bearing(test::distorted_camera, pixel);
      }
    };
    const Start start = run(test::framesOnAWall(31), sideways, 60, seed, background_stays);
    EXPECT_EQ(start.accepted_at, -1) << start.initialisation.description();
    EXPECT_NE(start.initialisation.waitingFor().find("the camera seems to stand"), std::string::npos)
        << start.initialisation.waitingFor();
  }
}

TEST(Initialisation, TheProvisionalViewHoldsTheFirstFramesPoints) {
  const Start start = run(test::framesOnAWall(27), still, 12, 11);
  MapView view;
  start.initialisation.writeProvisional(view);
  EXPECT_EQ(view.origin_frame, 0);
  EXPECT_EQ(view.keyframes.size(), 1U);
  ASSERT_EQ(view.points.size(), start.first_points.size());
  for (std::size_t i = 0; i < view.points.size(); ++i) {
    EXPECT_EQ(view.points[i].id, start.first_points[i]);
    EXPECT_GT(view.points[i].inverse_depth, 0);
  }
}

TEST(Initialisation, StartingAnewForgetsWhatWas) {
  Start start = run(test::framesOnAWall(28), sideways, 14, 12);
  TrackedFrame first;
  first.frame_index = 100;
  test::Random random(13);
  first.observations =
      test::observeAll(test::distorted_camera, test::framesOnAWall(29), still(0), test::Sight(), random);
  first.observations.resize(40);
  start.initialisation.start(first);
  MapView view;
  start.initialisation.writeProvisional(view);
  EXPECT_EQ(view.origin_frame, 100);
  EXPECT_EQ(view.points.size(), 40U);
  EXPECT_FALSE(start.initialisation.changed());
}

TEST(Initialisation, TheSameFramesGiveTheSameMapToTheLastBit) {
  const Start a = run(test::framesOnAWall(30), sideways, 90, 14), b = run(test::framesOnAWall(30), sideways, 90, 14);
  ASSERT_GT(a.accepted_at, 0);
  EXPECT_EQ(a.accepted_at, b.accepted_at);
  EXPECT_EQ(a.initialisation.description(), b.initialisation.description());
  const Map first = a.initialisation.map(), second = b.initialisation.map();
  ASSERT_EQ(first.points.size(), second.points.size());
  for (const auto& [id, point] : first.points) EXPECT_EQ(second.points.at(id).inverse_depth, point.inverse_depth);
  for (std::size_t k = 0; k < first.keyframes.size(); ++k) {
    EXPECT_EQ(first.keyframes[k].world_T_camera.translation, second.keyframes[k].world_T_camera.translation);
  }
}

}  // namespace
}  // namespace edgeslam
