#include "simulator/simulator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "edgeslam/input_error.h"
#include "geometry/rolling_shutter.h"
#include "unit/simulator/image_edge.h"

namespace edgeslam {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

SimulationOptions smallOptions(SceneKind scene) {
  SimulationOptions options;
  options.scene = scene;
  options.width = 320;
  options.height = 240;
  options.frames = 40;
  return options;
}

// Offsets of the panels' upper edges, which stand out against the dark wall, from where the ground truth has them [px].
std::vector<double> panelEdgeOffsets(const SimulatedSequence& sequence, int index, double reach) {
  const SimulatedFrame frame = sequence.frame(index);
  cv::Mat grey;
  frame.grey.convertTo(grey, CV_32F);
  const Pose camera_T_world = frame.world_T_camera.inverse();
  constexpr double step_s = 0.02;
  const double time_s = index / sequence.options.fps;
  const Twist twist =
      twistBetween(poseAt(sequence.motion, time_s - step_s / 2), poseAt(sequence.motion, time_s + step_s / 2), step_s);
  std::vector<double> offsets;
  for (const SceneRectangle& r : sequence.scene.scene.rectangles) {
    // Front faces: as high as a panel and turned to the camera.
    for (const auto& [base, along, up] :
         {std::make_tuple(r.corner, r.side_s, r.side_t), std::make_tuple(r.corner, r.side_t, r.side_s)}) {
      const bool upright = std::abs(up.z() - 1.95) < 1e-6 && along.norm() > 0.5;
      if (!upright || r.side_s.cross(r.side_t).y() > 0) continue;
      const auto at = [&, b = base, a = along, u = up](double share) {
        return projectToRow(sequence.camera, twist, camera_T_world * (b + u + share * a));
      };
      for (double share = 0.2; share < 0.81; share += 0.05) {
        const Vector2d pixel = at(share), direction = (at(share + 0.01) - at(share - 0.01)).normalized();
        if ((camera_T_world * (base + up + share * along)).z() < 0.5 || !insideImage(sequence.camera, pixel, reach + 2))
          continue;
        offsets.push_back(edgeOffset(grey, pixel, Vector2d(-direction.y(), direction.x()), reach));
      }
    }
  }
  return offsets;
}

TEST(Simulator, ImagesAgreeWithTheGroundTruth) {
  SimulationOptions options = smallOptions(SceneKind::panels);
  options.noise = 0;
  for (const auto& [exposure_ms, readout_ms] : {std::pair(0.0, 0.0), std::pair(30.0, 0.0), std::pair(0.0, 30.0)}) {
    options.exposure_ms = exposure_ms;
    options.readout_ms = readout_ms;
    SimulatedSequence sequence = makeSequence(options);
    // Plain surfaces, so that nothing but the edge shows in a profile.
    for (cv::Mat& light : sequence.scene.light) light.setTo(cv::mean(light));
    std::vector<double> sizes;
    double sum = 0;
    for (const int index : {0, 13, 26, 39}) {
      for (const double offset : panelEdgeOffsets(sequence, index, 3)) {
        sizes.push_back(std::abs(offset));
        sum += offset;
      }
    }
    ASSERT_GT(sizes.size(), 40U);
    std::sort(sizes.begin(), sizes.end());
    // Where the image is blurred, the vignetting's slope moves the measured edge a little.
    EXPECT_LT(sizes[sizes.size() * 9 / 10], exposure_ms > 0 ? 0.08 : 0.05) << exposure_ms;
    EXPECT_LT(sizes.back(), exposure_ms > 0 ? 0.16 : 0.1) << exposure_ms;
    EXPECT_LT(std::abs(sum / static_cast<double>(sizes.size())), 0.03) << exposure_ms;
  }
}

TEST(Simulator, SameSeedSameBytesInAnyOrder) {
  const SimulationOptions options = smallOptions(SceneKind::panels_textured);
  const SimulatedSequence first = makeSequence(options), second = makeSequence(options);
  const SimulatedFrame late = first.frame(20), early = first.frame(3);
  const SimulatedFrame early_again = second.frame(3), late_again = second.frame(20);
  EXPECT_EQ(cv::norm(early.grey, early_again.grey, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(late.grey, late_again.grey, cv::NORM_INF), 0);
  EXPECT_EQ(early.world_T_camera.translation, early_again.world_T_camera.translation);
  EXPECT_EQ(early.time_ns, early_again.time_ns);
}

TEST(Simulator, AnotherSeedAnotherImage) {
  SimulationOptions options = smallOptions(SceneKind::panels);
  const cv::Mat first = makeSequence(options).frame(5).grey;
  options.seed = 2;
  EXPECT_GT(cv::norm(first, makeSequence(options).frame(5).grey, cv::NORM_INF), 0);
}

TEST(Simulator, BlurGrowsWithTheSpeed) {
  SimulationOptions options = smallOptions(SceneKind::panels_textured);
  options.noise = 0;
  options.exposure_ms = 25;
  double sharper = std::numeric_limits<double>::infinity();
  for (const double speed : {0.1, 3.0, 9.0}) {
    options.speed = speed;
    cv::Mat edges;
    cv::Scalar mean, deviation;
    // The first frame is taken from the same place at every speed.
    cv::Laplacian(makeSequence(options).frame(0).grey, edges, CV_32F);
    cv::meanStdDev(edges, mean, deviation);
    EXPECT_LT(deviation[0], 0.9 * sharper) << speed;
    sharper = deviation[0];
  }
}

// A bright plane to the right of a vertical edge straight ahead, 1 m away, before a dark one, as an ideal lens sees it.
// An odd number of rows: one is the middle row.
SimulatedSequence sequenceOfAnEdge(double readout_ms) {
  SimulationOptions options = smallOptions(SceneKind::panels);
  options.height = 241;
  options.frames = 1;
  options.noise = 0;
  options.exposure_ms = 0;
  options.speed = 0.05;
  options.readout_ms = readout_ms;
  SimulatedSequence sequence = makeSequence(options);
  sequence.camera.distortion.fill(0);
  sequence.rays = makeRayTable(sequence.camera);
  sequence.motion = CameraMotion();
  sequence.motion.speed = 0;
  const Pose start = poseAt(sequence.motion, 0);
  sequence.scene = LitScene();
  const auto add = [&](const Vector3d& corner, double albedo) {
    SceneRectangle plane;
    plane.corner = start * corner;
    plane.side_s = start.rotation * Vector3d(40, 0, 0);
    plane.side_t = start.rotation * Vector3d(0, -40, 0);
    plane.albedo = albedo;
    sequence.scene.scene.rectangles.push_back(plane);
    sequence.scene.light.emplace_back(2, 2, CV_32F, cv::Scalar(1));
  };
  add({-20, 20, 1.5}, 0.2);
  add({0, 20, 1}, 0.7);
  sequence.gains = {1};
  return sequence;
}

// The same, seen by a camera that moves steadily along or about an axis of its own [m/s or rad/s].
SimulatedSequence sequenceOfAPassingEdge(double readout_ms, std::size_t axis, double speed) {
  SimulatedSequence sequence = sequenceOfAnEdge(readout_ms);
  constexpr double amplitude = 20;  // so slow a sway is steady about its middle
  sequence.motion.tremor[axis] = {{amplitude, speed / (2 * M_PI * amplitude), 0}};
  return sequence;
}

// Column of the edge in a row [px].
double edgeColumn(const cv::Mat& grey, const SimulatedSequence& sequence, int row) {
  cv::Mat image;
  grey.convertTo(image, CV_32F);
  const Vector2d middle(sequence.camera.cx, row);
  return middle.x() + edgeOffset(image, middle, Vector2d(1, 0), 8);
}

constexpr std::size_t sideways = 0, about_the_upright = 4;  // axes of a pose's update

TEST(Simulator, AReadoutShearsAsFarAsTheCameraMoves) {
  constexpr double speed = 0.8;  // [m/s] at 1 m, and [rad/s]
  constexpr int first = 20, last = 220;
  for (const std::size_t axis : {sideways, about_the_upright}) {
    for (const double readout_ms : {0.0, 24.0, -24.0}) {
      const SimulatedSequence sequence = sequenceOfAPassingEdge(readout_ms, axis, speed);
      const cv::Mat grey = sequence.frame(0).grey;
      // To the right the camera moves, to the left the edge: in rows read later, it is farther left.
      const double share = (last - first) / 240.0;
      const double expected = -speed * 1e-3 * readout_ms * sequence.camera.fx * share;
      EXPECT_NEAR(edgeColumn(grey, sequence, last) - edgeColumn(grey, sequence, first), expected, 0.05)
          << axis << " " << readout_ms;
      EXPECT_NEAR(std::abs(expected), readout_ms == 0 ? 0 : 4.258, 0.001);
      // Straight: halfway in time is halfway in space.
      EXPECT_NEAR(edgeColumn(grey, sequence, 170) - edgeColumn(grey, sequence, 120), expected / 4, 0.05);
    }
  }
}

TEST(Simulator, TheMiddleRowIsThatOfAGlobalShutter) {
  for (const std::size_t axis : {sideways, about_the_upright}) {
    const SimulatedSequence global = sequenceOfAPassingEdge(0, axis, 0.8);
    const SimulatedFrame expected = global.frame(0);
    for (const double readout_ms : {24.0, -24.0}) {
      const SimulatedFrame frame = sequenceOfAPassingEdge(readout_ms, axis, 0.8).frame(0);
      EXPECT_EQ(frame.time_ns, expected.time_ns);
      EXPECT_EQ(frame.world_T_camera.translation, expected.world_T_camera.translation);
      EXPECT_LE(cv::norm(frame.grey.row(120), expected.grey.row(120), cv::NORM_INF), 1);
      for (const int row : {0, 240}) {
        EXPECT_GT(cv::norm(frame.grey.row(row), expected.grey.row(row), cv::NORM_INF), 50) << row;
      }
    }
  }
}

TEST(Simulator, AReadoutDoesNotShowWhereTheCameraStands) {
  SimulationOptions options = smallOptions(SceneKind::panels);
  options.still = {{5, 20}};
  options.noise = 0;
  const cv::Mat global = makeSequence(options).frame(15).grey;
  options.readout_ms = 30;
  EXPECT_LE(cv::norm(global, makeSequence(options).frame(15).grey, cv::NORM_INF), 1);
}

TEST(Simulator, WithoutAReadoutImagesAreThoseOfAGlobalShutter) {
  SimulationOptions options = smallOptions(SceneKind::panels_textured);
  const SimulatedSequence usual = makeSequence(options);
  options.readout_ms = 0;
  const SimulatedSequence none = makeSequence(options);
  options.readout_ms = 24;
  const SimulatedSequence rolling = makeSequence(options);
  EXPECT_EQ(none.camera.readout_s, 0);
  EXPECT_DOUBLE_EQ(rolling.camera.readout_s, 0.024);
  for (const int index : {0, 20}) {
    const cv::Mat grey = usual.frame(index).grey;
    EXPECT_EQ(cv::norm(grey, none.frame(index).grey, cv::NORM_INF), 0) << index;
    EXPECT_GT(cv::norm(grey, rolling.frame(index).grey, cv::NORM_INF), 20) << index;
  }
}

TEST(Simulator, TimesFollowTheFrameRate) {
  SimulationOptions options = smallOptions(SceneKind::panels);
  options.fps = 20;
  const SimulatedSequence sequence = makeSequence(options);
  EXPECT_EQ(sequence.time(7) - sequence.time(0), 350'000'000);
  EXPECT_EQ(sequence.frame(7).time_ns, sequence.time(7));
}

TEST(Simulator, ATurnIsOnTheSpotAndComesBack) {
  SimulationOptions options = smallOptions(SceneKind::room);
  options.frames = 60;
  options.turned = {{20, 30}};
  const SimulatedSequence sequence = makeSequence(options);
  const Pose before = sequence.groundTruth(20);
  double farthest = 0;
  for (int i = 20; i <= 49; ++i) {
    const Pose turned = sequence.groundTruth(i);
    EXPECT_LT((turned.translation - before.translation).norm(), 1e-9) << i;
    farthest = std::max(farthest, rotationAngle(before.rotation, turned.rotation));
  }
  EXPECT_NEAR(farthest * 180 / M_PI, 40, 2);
  EXPECT_LT(rotationAngle(before.rotation, sequence.groundTruth(50).rotation), 0.01);
}

TEST(Simulator, FaultsComeInTheirFrames) {
  SimulationOptions options = smallOptions(SceneKind::room);
  options.covered = {{5, 4}};
  options.shaken = {{15, 8}};
  options.still = {{30, 10}};
  const SimulatedSequence sequence = makeSequence(options);
  for (const int index : {5, 8}) EXPECT_LT(cv::mean(sequence.frame(index).grey)[0], 20);
  for (const int index : {4, 9}) EXPECT_GT(cv::mean(sequence.frame(index).grey)[0], 60);
  const auto turned = [&](int index) {
    return rotationAngle(sequence.groundTruth(index).rotation, sequence.groundTruth(index + 1).rotation);
  };
  double most_shaken = 0, most_calm = 0;
  for (int i = 15; i < 22; ++i) most_shaken = std::max(most_shaken, turned(i));
  for (int i = 0; i < 14; ++i) most_calm = std::max(most_calm, turned(i));
  EXPECT_GT(most_shaken, 2 * most_calm);
  for (int i = 30; i < 39; ++i) EXPECT_LT(turned(i), 1e-7);
}

TEST(Simulator, CorridorClosesItsLoopByDefault) {
  SimulationOptions options = smallOptions(SceneKind::corridor);
  options.frames = 0;
  options.fps = 10;
  const SimulatedSequence sequence = makeSequence(options);
  const Vector3d start = sequence.groundTruth(0).translation;
  double nearest = 100;
  for (int i = sequence.size() * 3 / 4; i < sequence.size(); ++i) {
    nearest = std::min(nearest, (sequence.groundTruth(i).translation - start).norm());
  }
  EXPECT_LT(nearest, 0.1);
  EXPECT_GT((sequence.groundTruth(sequence.size() - 1).translation - start).norm(), 0.5);
}

TEST(Simulator, ExposureSuitsEveryScene) {
  for (const SceneKind scene : {SceneKind::panels, SceneKind::panels_textured, SceneKind::room, SceneKind::corridor}) {
    const SimulatedSequence sequence = makeSequence(smallOptions(scene));
    const cv::Mat grey = sequence.frame(20).grey;
    EXPECT_NEAR(cv::mean(grey)[0], 112, 35) << sceneName(scene);
    EXPECT_LT(cv::countNonZero(grey == 255), 0.05 * static_cast<double>(grey.total())) << sceneName(scene);
  }
}

TEST(Simulator, FisheyeAndOtherSizesWork) {
  for (const auto& [width, height] : {std::make_pair(64, 64), std::make_pair(100, 333), std::make_pair(401, 97)}) {
    for (const bool fisheye : {false, true}) {
      if (fisheye && width != height) continue;
      SimulationOptions options = smallOptions(SceneKind::corridor);
      options.width = width;
      options.height = height;
      options.fisheye = fisheye;
      const cv::Mat grey = makeSequence(options).frame(0).grey;
      EXPECT_EQ(grey.size(), cv::Size(width, height));
    }
  }
}

TEST(Simulator, RefusesBadOptions) {
  const auto refused = [](auto change) {
    SimulationOptions options = smallOptions(SceneKind::panels);
    change(options);
    EXPECT_THROW(makeSequence(options), InputError);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  refused([](SimulationOptions& o) { o.frames = -1; });
  refused([](SimulationOptions& o) { o.frames = 2'000'000'000; });
  refused([](SimulationOptions& o) { o.width = 0; });
  refused([](SimulationOptions& o) { o.height = 1'000'000; });
  refused([](SimulationOptions& o) { o.fps = 0; });
  refused([nan](SimulationOptions& o) { o.fps = nan; });
  refused([](SimulationOptions& o) { o.noise = -1; });
  refused([nan](SimulationOptions& o) { o.noise = nan; });
  refused([](SimulationOptions& o) { o.exposure_ms = 34; });
  for (const double readout_ms : {34.0, -34.0, nan}) refused([=](SimulationOptions& o) { o.readout_ms = readout_ms; });
  refused([](SimulationOptions& o) { o.fps = 2, o.readout_ms = 201; });
  refused([](SimulationOptions& o) { o.speed = 0; });
  refused([](SimulationOptions& o) { o.covered = {{30, 11}}; });
  refused([](SimulationOptions& o) { o.shaken = {{-1, 5}}; });
  refused([](SimulationOptions& o) { o.still = {{3, 0}}; });
  refused([](SimulationOptions& o) { o.turned = {{3, 0}}; });
  refused([](SimulationOptions& o) { o.still = {{1, std::numeric_limits<int>::max()}}; });
}

TEST(Simulator, ReadsFrameRangesAndSceneNames) {
  EXPECT_EQ(parseFrameRange("12:34").first, 12);
  EXPECT_EQ(parseFrameRange("12:34").count, 34);
  for (const char* bad :
       {"", ":", "12", "12:", ":3", "-1:3", "1:0", "1:2:3", "1:2 ", " 1:2", "a:b", "99999999999:1", "1,2"}) {
    EXPECT_THROW(parseFrameRange(bad), InputError) << bad;
  }
  EXPECT_EQ(sceneKindOfName("room"), SceneKind::room);
  EXPECT_THROW(sceneKindOfName("Room"), InputError);
  EXPECT_THROW(sceneKindOfName(""), InputError);
}

}  // namespace
}  // namespace edgeslam
