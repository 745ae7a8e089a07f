// How well a pose is known in the world: tracking's own share, and the map's where the camera looks.
#include "tracking/world_uncertainty.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace edgeslam {
namespace {

// Keyframes that are known so well [map units, rad], and so many points hosted in each, all of them followed.
struct Place {
  MapView view;
  std::vector<Track> tracks;

  Place(const std::vector<double>& sigmas, const std::vector<int>& points) {
    for (std::size_t i = 0; i < sigmas.size(); ++i) {
      ViewKeyframe keyframe;
      keyframe.id = static_cast<KeyframeId>(3 * i);
      keyframe.uncertainty.diagonal().setConstant(sigmas[i] * sigmas[i]);
      view.keyframes.push_back(keyframe);
      for (int k = 0; k < points[i]; ++k) {
        ViewPoint point;
        point.id = static_cast<PointId>(view.points.size());
        point.host = keyframe.id;
        point.host_bearing.setZero();
        view.points.push_back(point);
        Track track;
        track.id = point.id;
        tracks.push_back(track);
      }
    }
  }

  // At the keyframes, which are all at the origin.
  double sigma() const { return std::sqrt(mapUncertaintyAt(view, tracks, Pose())(0, 0)); }
};

TEST(MapUncertaintyAt, IsWhatTwoOfThreePointsInViewAreKnownBy) {
  EXPECT_NEAR(Place({0.01, 0.1, 1}, {70, 20, 10}).sigma(), 0.01, 1e-12);
  EXPECT_NEAR(Place({0.01, 0.1, 1}, {60, 20, 20}).sigma(), 0.1, 1e-12);
  EXPECT_NEAR(Place({0.01, 0.1, 1}, {20, 20, 60}).sigma(), 1, 1e-12);
}

TEST(MapUncertaintyAt, DoesNotDependOnTheOrderOfTheKeyframes) {
  EXPECT_NEAR(Place({1, 0.01, 0.1}, {20, 60, 20}).sigma(), 0.1, 1e-12);
}

TEST(MapUncertaintyAt, FewOldPointsDoNotMakeTheCameraAsCertainAsTheyAre) {
  EXPECT_NEAR(Place({0, 0.1, 0.1, 0.1}, {40, 30, 30, 30}).sigma(), 0.1, 1e-12);
}

TEST(MapUncertaintyAt, IsTheLatestKeyframesWhereNothingOfTheMapIsInView) {
  Place place({0.01, 0.1}, {10, 10});
  place.tracks.clear();
  EXPECT_NEAR(place.sigma(), 0.1, 1e-12);
}

TEST(MapUncertaintyAt, GrowsWithTheDistanceByWhatIsOpenOfTheDirection) {
  const Place place({0.1}, {10});
  Pose beside;
  beside.translation.x() = 2;
  const Matrix6d covariance = mapUncertaintyAt(place.view, place.tracks, beside);
  EXPECT_GT(covariance(1, 1), 3 * 0.1 * 0.1);
  EXPECT_NEAR(covariance(3, 3), 0.1 * 0.1, 1e-12);
}

TEST(WorldCovariance, GrowsWithWhatContradictsThePose) {
  Camera camera;
  camera.fx = camera.fy = 500;
  const WorldUncertaintyOptions options;
  const Matrix6d measured = 1e-6 * Matrix6d::Identity();
  const auto variance = [&](double outlier_share) {
    return worldCovariance(camera, measured, Matrix6d::Zero(), outlier_share, options)(0, 0);
  };
  EXPECT_NEAR(variance(options.doubling_outlier_share), 2 * variance(0), 1e-12);
  EXPECT_NEAR(variance(2 * options.doubling_outlier_share), 5 * variance(0), 1e-12);
}

TEST(WorldCovariance, DirectionsAreNeverKnownBetterThanTheCalibration) {
  Camera camera;
  camera.fx = camera.fy = 500;
  const Matrix6d covariance = worldCovariance(camera, Matrix6d::Zero(), Matrix6d::Zero(), 0, {});
  EXPECT_NEAR(std::sqrt(covariance(4, 4)), 0.5 / 500, 1e-9);
  EXPECT_EQ(covariance(1, 1), 0);
}

}  // namespace
}  // namespace edgeslam
