#include "geometry/one_to_one.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "unit/geometry/scene_fixture.h"

namespace edgeslam {
namespace {

TEST(OneToOne, CalibrationsAreAndOnesThatFoldTheImageAreNot) {
  for (const NamedCamera& named : cameras()) {
    EXPECT_TRUE(isOneToOne(named.camera)) << named.name;
    for (const double folding : {-1.0, -3.0, std::nan("")}) {
      Camera folded = named.camera;
      folded.distortion = {folding, 0, 0, 0, 0};
      EXPECT_FALSE(isOneToOne(folded)) << named.name << ", " << folding;
    }
  }
}

// The Kinect's, as others have calibrated it: without its last coefficient its corners are images of nothing.
TEST(OneToOne, AllCoefficientsCount) {
  Camera kinect = pinholeCamera();
  kinect.distortion = {0.2624, -0.9531, -0.0054, 0.0026, 1.1633};
  EXPECT_TRUE(isOneToOne(kinect));
  kinect.distortion[4] = 0;
  EXPECT_FALSE(isOneToOne(kinect));
}

TEST(OneToOne, TheFarthestCornerIsThatFarthestFromTheCentre) {
  Camera camera = pinholeCamera();
  camera.cx = 0;
  EXPECT_NEAR(farthestCorner(camera) * camera.fx,
              std::hypot(camera.width - 1, std::max(camera.cy, camera.height - 1 - camera.cy) * camera.fx / camera.fy),
              1e-9);
}

}  // namespace
}  // namespace edgeslam
