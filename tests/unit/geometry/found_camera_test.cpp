#include "geometry/found_camera.h"

#include <gtest/gtest.h>

#include "unit/adjustment/synthetic_scene.h"

namespace edgeslam {
namespace {

TEST(FoundCamera, NothingFoundLeavesTheCalibrationAsItIs) {
  Camera camera = test::testCamera(CameraModel::kannala_brandt);
  camera.readout_s = 0.01;
  EXPECT_TRUE(withFound(camera, FoundCamera()) == camera);
}

TEST(FoundCamera, WhatWasFoundCounts) {
  Camera camera = test::testCamera(CameraModel::pinhole_radial_tangential);
  camera.readout_s = 0.01;
  const Camera found = withFound(camera, {0.02, 0.9});
  EXPECT_EQ(found.readout_s, 0.02);
  EXPECT_DOUBLE_EQ(found.fx, 0.9 * camera.fx);
  EXPECT_DOUBLE_EQ(found.fy, 0.9 * camera.fy);
  EXPECT_EQ(found.cx, camera.cx);
  EXPECT_EQ(withFound(camera, {0.0, 1}).readout_s, 0) << "also that the shutter is a global one";
}

}  // namespace
}  // namespace edgeslam
