// What a frame saw, packed: hardly anything is lost.
#include "tracking/seen_points.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/adjustment/synthetic_scene.h"

namespace edgeslam {
namespace {

Camera wideCamera() {
  Camera camera;
  camera.width = 1920;
  camera.height = 1080;
  return camera;
}

Track measuredTrack(PointId id, const Eigen::Vector2f& pixel, double angle, float sigma_normal, float sigma_tangent) {
  Track track;
  track.id = id;
  track.pixel = pixel;
  track.normal = Eigen::Vector2d(std::cos(angle), std::sin(angle)).cast<float>();
  track.sigma_normal = sigma_normal;
  track.sigma_tangent = sigma_tangent;
  return track;
}

TEST(SeenPoints, AreWhatTheTracksWere) {
  test::Random random(1);
  std::vector<Track> tracks;
  for (PointId id = 7; id < 500; id += 3) {
    const Eigen::Vector2d pixel(test::uniform(random, 0, 1919), test::uniform(random, 0, 1079));
    tracks.push_back(measuredTrack(5'000'000'000 + id, pixel.cast<float>(), test::uniform(random, -M_PI, M_PI),
                                   static_cast<float>(test::uniform(random, 0.05, 3)), id % 2 == 0 ? 1000.F : 0.4F));
  }
  SeenPoints seen;
  pack(wideCamera(), tracks, tracks.size(), seen);
  ASSERT_EQ(seen.points.size(), tracks.size());
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const auto [point, measurement] = seenPoint(seen, i);
    const Measurement was = measurementOf(tracks[i]);
    EXPECT_EQ(point, tracks[i].id);
    EXPECT_LT((measurement.pixel - was.pixel).norm(), 0.03);
    EXPECT_LT((measurement.normal - was.normal).norm(), 0.001);
    EXPECT_NEAR(measurement.normal.norm(), 1, 1e-12);
    EXPECT_NEAR(measurement.sigma_normal, was.sigma_normal, 0.001 * was.sigma_normal);
    EXPECT_NEAR(measurement.sigma_tangent, was.sigma_tangent, 0.001 * was.sigma_tangent);
  }
}

TEST(SeenPoints, AreNoMoreThanThereIsMemoryFor) {
  std::vector<Track> tracks;
  for (PointId id = 0; id < 20; ++id) tracks.push_back(measuredTrack(id, {100, 100}, 0, 1, 1));
  SeenPoints seen;
  pack(wideCamera(), tracks, 12, seen);
  ASSERT_EQ(seen.points.size(), 12U);
  EXPECT_EQ(seenPoint(seen, 11).point, 11);
  pack(wideCamera(), {}, 12, seen);
  EXPECT_TRUE(seen.points.empty());
}

}  // namespace
}  // namespace edgeslam
