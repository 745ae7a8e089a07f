// Two maps are the same, numbers to the last bit and images with their borders.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <opencv2/core.hpp>

#include "map/map_file.h"

namespace edgeslam::test {

inline void expectSameBits(const double* expected, const double* found, std::size_t count, const char* what) {
  EXPECT_EQ(std::memcmp(expected, found, count * sizeof(double)), 0) << what;
}

inline cv::Mat withBorder(cv::Mat level) {
  level.adjustROI(pyramid_border, pyramid_border, pyramid_border, pyramid_border);
  return level;
}

inline void expectSameImages(const FrameImages& expected, const FrameImages& found) {
  EXPECT_EQ(found.frame_index, expected.frame_index);
  EXPECT_EQ(found.time_ns, expected.time_ns);
  ASSERT_EQ(found.pyramid.levels.size(), expected.pyramid.levels.size());
  for (std::size_t i = 0; i < expected.pyramid.levels.size(); ++i) {
    const cv::Mat a = withBorder(expected.pyramid.levels[i]), b = withBorder(found.pyramid.levels[i]);
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(cv::countNonZero(a != b), 0) << "level " << i;
  }
}

inline void expectSameObservation(const PointObservation& expected, const PointObservation& found) {
  EXPECT_EQ(found.point, expected.point);
  expectSameBits(expected.measurement.pixel.data(), found.measurement.pixel.data(), 2, "pixel");
  expectSameBits(expected.measurement.normal.data(), found.measurement.normal.data(), 2, "normal");
  expectSameBits(&expected.measurement.sigma_normal, &found.measurement.sigma_normal, 1, "sigma across");
  expectSameBits(&expected.measurement.sigma_tangent, &found.measurement.sigma_tangent, 1, "sigma along");
  expectSameBits(expected.bearing.data(), found.bearing.data(), 3, "bearing");
  EXPECT_EQ(found.corner, expected.corner);
  EXPECT_EQ(found.chain, expected.chain);
  EXPECT_EQ(found.order, expected.order);
  EXPECT_EQ(found.straight_edge, expected.straight_edge);
}

inline void expectSameEdge(const SeenEdge& expected, const SeenEdge& found) {
  EXPECT_EQ(found.line, expected.line);
  expectSameBits(expected.from.pixel.data(), found.from.pixel.data(), 2, "an end's pixel");
  expectSameBits(expected.from.bearing.data(), found.from.bearing.data(), 3, "an end's bearing");
  expectSameBits(expected.to.pixel.data(), found.to.pixel.data(), 2, "the other end's pixel");
  expectSameBits(expected.to.bearing.data(), found.to.bearing.data(), 3, "the other end's bearing");
  expectSameBits(&expected.sigma, &found.sigma, 1, "an edge's sigma");
}

inline void expectSameLine(const MapLine& expected, const MapLine& found) {
  EXPECT_EQ(found.id, expected.id);
  EXPECT_EQ(found.host, expected.host);
  expectSameBits(expected.in_host.point.data(), found.in_host.point.data(), 3, "a line's point");
  expectSameBits(expected.in_host.direction.data(), found.in_host.direction.data(), 3, "a line's direction");
  EXPECT_EQ(found.is_placed, expected.is_placed);
  expectSameBits(&expected.begin, &found.begin, 1, "a line's begin");
  expectSameBits(&expected.end, &found.end, 1, "a line's end");
  EXPECT_EQ(found.seen_in, expected.seen_in);
}

inline void expectSameKeyframe(const Keyframe& expected, const Keyframe& found) {
  EXPECT_EQ(found.id, expected.id);
  EXPECT_EQ(found.frame_index, expected.frame_index);
  EXPECT_EQ(found.time_ns, expected.time_ns);
  EXPECT_EQ(found.reason, expected.reason);
  const Pose &pose = expected.world_T_camera, &found_pose = found.world_T_camera;
  expectSameBits(pose.rotation.coeffs().data(), found_pose.rotation.coeffs().data(), 4, "rotation");
  expectSameBits(pose.translation.data(), found_pose.translation.data(), 3, "translation");
  expectSameBits(expected.twist.data(), found.twist.data(), 6, "twist");
  ASSERT_EQ(found.observations.size(), expected.observations.size());
  for (std::size_t i = 0; i < expected.observations.size(); ++i) {
    expectSameObservation(expected.observations[i], found.observations[i]);
  }
  ASSERT_EQ(found.straight_edges.size(), expected.straight_edges.size());
  for (std::size_t i = 0; i < expected.straight_edges.size(); ++i) {
    expectSameEdge(expected.straight_edges[i], found.straight_edges[i]);
  }
  ASSERT_EQ(static_cast<bool>(found.images), static_cast<bool>(expected.images));
  if (expected.images) expectSameImages(*expected.images.get(), *found.images.get());
}

inline void expectSamePoint(const MapPoint& expected, const MapPoint& found) {
  EXPECT_EQ(found.id, expected.id);
  EXPECT_EQ(found.host, expected.host);
  expectSameBits(expected.host_bearing.data(), found.host_bearing.data(), 3, "host bearing");
  expectSameBits(&expected.inverse_depth, &found.inverse_depth, 1, "inverse depth");
  expectSameBits(&expected.inverse_depth_sigma, &found.inverse_depth_sigma, 1, "its sigma");
  EXPECT_EQ(found.corner, expected.corner);
  EXPECT_EQ(found.chain_keyframe, expected.chain_keyframe);
  EXPECT_EQ(found.chain, expected.chain);
  EXPECT_EQ(found.order, expected.order);
  EXPECT_EQ(found.seen_in, expected.seen_in);
}

inline void expectSame(const SavedMap& expected, const SavedMap& found) {
  EXPECT_EQ(found.camera.model, expected.camera.model);
  EXPECT_EQ(found.camera.width, expected.camera.width);
  EXPECT_EQ(found.camera.height, expected.camera.height);
  expectSameBits(&expected.camera.fx, &found.camera.fx, 1, "fx");
  expectSameBits(&expected.camera.fy, &found.camera.fy, 1, "fy");
  expectSameBits(&expected.camera.cx, &found.camera.cx, 1, "cx");
  expectSameBits(&expected.camera.cy, &found.camera.cy, 1, "cy");
  expectSameBits(expected.camera.distortion.data(), found.camera.distortion.data(), 5, "distortion");
  expectSameBits(&expected.camera.readout_s, &found.camera.readout_s, 1, "readout");
  ASSERT_EQ(found.map.keyframes.size(), expected.map.keyframes.size());
  for (const Keyframe& keyframe : expected.map.keyframes) {
    ASSERT_TRUE(found.map.keyframes.contains(keyframe.id));
    expectSameKeyframe(keyframe, found.map.keyframes[keyframe.id]);
  }
  ASSERT_EQ(found.map.points.size(), expected.map.points.size());
  for (const auto& [id, point] : expected.map.points) {
    ASSERT_EQ(found.map.points.count(id), 1U);
    expectSamePoint(point, found.map.points.at(id));
  }
  EXPECT_EQ(found.map.next_line, expected.map.next_line);
  ASSERT_EQ(found.map.lines.size(), expected.map.lines.size());
  for (const auto& [id, line] : expected.map.lines) {
    ASSERT_EQ(found.map.lines.count(id), 1U);
    expectSameLine(line, found.map.lines.at(id));
  }
  ASSERT_EQ(found.map.inertia.size(), expected.map.inertia.size());
  for (const auto& [world, alignment] : expected.map.inertia) {
    const InertialAlignment& other = found.map.inertia.at(world);
    EXPECT_EQ(other.is_known, alignment.is_known);
    expectSameBits(&alignment.metres_a_unit, &other.metres_a_unit, 1, "metres a unit");
    expectSameBits(&alignment.scale_sigma, &other.scale_sigma, 1, "the scale's sigma");
    expectSameBits(alignment.gravity.data(), other.gravity.data(), 3, "gravity");
  }
  ASSERT_EQ(found.map.wheels.size(), expected.map.wheels.size());
  for (const auto& [world, scale] : expected.map.wheels) {
    const WheelScale& other = found.map.wheels.at(world);
    EXPECT_EQ(other.is_known, scale.is_known);
    expectSameBits(&scale.metres_a_unit, &other.metres_a_unit, 1, "metres a unit by wheels");
    expectSameBits(&scale.sigma, &other.sigma, 1, "sigma by wheels");
  }
}

}  // namespace edgeslam::test
