// Points of straight edges are moved along them to where the pose says.
#include "tracking/edge_lock.h"

#include <gtest/gtest.h>

#include "unit/tracking/textured_plane.h"

namespace edgeslam {
namespace {

class EdgeLock : public ::testing::Test {
 protected:
  EdgeLock() {
    view_.initialised = true;
    view_.keyframes = {{0, {rotationExp({0.02, -0.03, 0.1}), {0.2, -0.1, 0.05}}, nullptr}};
    const Eigen::Vector3d in_camera = 3.0 * bearing(camera_, pixel_.cast<double>());
    view_.points = {viewPoint(view_, 7, 0, world_T_camera_ * in_camera)};
  }

  // A track that slid by `along` and is off by `across`, after the lock.
  Track locked(float along, float across, const Eigen::Vector2f& normal) {
    Track track = trackAt(7, pixel_, normal);
    track.pixel += along * Eigen::Vector2f(-track.normal.y(), track.normal.x()) + across * track.normal;
    adjust_(track);
    before_ = track;
    std::vector<Track> tracks{track};
    lockAlongEdges(camera_, view_, world_T_camera_, options_, tracks);
    EXPECT_EQ(tracks.size(), 1U);
    return tracks[0];
  }

  void expectUntouched() { EXPECT_EQ(locked(2, 0.3f, {1, 0.4f}).pixel, before_.pixel); }

  const Camera camera_ = smallCamera();
  Pose world_T_camera_{rotationExp({0.1, 0.05, -0.02}), {-0.1, 0.2, 0.1}};
  Eigen::Vector2f pixel_{140, 90};
  MapView view_;
  EdgeLockOptions options_;
  std::function<void(Track&)> adjust_ = [](Track&) {};
  Track before_;
};

TEST_F(EdgeLock, MovesAPointOfAStraightEdgeBackAlongItAndNotAcross) {
  for (const Eigen::Vector2f& normal : {Eigen::Vector2f(1, 0), {0, -1}, {0.6f, 0.8f}, {-2, 1}}) {
    for (const float along : {-3.5f, -0.2f, 0.0f, 2.5f}) {
      const Eigen::Vector2f expected = pixel_ + 0.4f * normal.normalized();
      EXPECT_LT((locked(along, 0.4f, normal).pixel - expected).norm(), 1e-3f);
    }
  }
}

TEST_F(EdgeLock, LeavesCornersAlone) {
  adjust_ = [](Track& track) { track.corner = true; };
  expectUntouched();
}

TEST_F(EdgeLock, LeavesAPointAloneThatIsKnownAlongItsEdge) {
  adjust_ = [](Track& track) { track.sigma_tangent = 9.9f * track.sigma_normal; };
  expectUntouched();
  adjust_ = [](Track& track) { track.sigma_tangent = 10.1f * track.sigma_normal; };
  EXPECT_NE(locked(2, 0.3f, {1, 0.4f}).pixel, before_.pixel);
}

TEST_F(EdgeLock, DoesNotBelieveAFarMove) {
  EXPECT_EQ(locked(4.1f, 0, {1, 0.4f}).pixel, before_.pixel);
  EXPECT_NE(locked(3.9f, 0, {1, 0.4f}).pixel, before_.pixel);
}

TEST_F(EdgeLock, NeedsAMapPointBeforeTheCamera) {
  adjust_ = [](Track& track) { track.id = 8; };
  expectUntouched();
  adjust_ = [](Track&) {};
  world_T_camera_.rotation = world_T_camera_.rotation * rotationExp({0, M_PI, 0});
  expectUntouched();
}

TEST_F(EdgeLock, DoesNotMoveOutOfTheImage) {
  const Eigen::Vector2f edge_of_image(140, 7);  // nearer than 8 px
  view_.points = {viewPoint(view_, 7, 0, world_T_camera_ * (3.0 * bearing(camera_, edge_of_image.cast<double>())))};
  pixel_ = {140, 9};
  EXPECT_EQ(locked(0, 0, {1, 0}).pixel, before_.pixel);
}

TEST_F(EdgeLock, MayBeSwitchedOff) {
  options_.enabled = false;
  expectUntouched();
}

}  // namespace
}  // namespace edgeslam
