// A small map of made-up numbers, awkward ones among them, that keeps to all rules of a map.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <random>

#include "map/map_file.h"

namespace edgeslam::test {

inline cv::Mat noiseImage(int width, int height, int seed) {
  std::mt19937 random(static_cast<std::mt19937::result_type>(seed));
  cv::Mat image(height, width, CV_8U);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) image.at<unsigned char>(y, x) = static_cast<unsigned char>(random() >> 24);
  }
  return image;
}

inline std::shared_ptr<FrameImages> madeImages(int width, int height, int levels, int seed) {
  auto images = std::make_shared<FrameImages>();
  images->frame_index = 31 * seed;
  images->time_ns = 1'000'000'007LL * seed;
  images->pyramid = buildPyramid(noiseImage(width, height, seed), levels);
  return images;
}

inline PointObservation madeObservation(PointId point, KeyframeId keyframe, int width, int height) {
  const double turn = 0.1 + 0.7 * static_cast<double>(point) + 0.3 * keyframe;
  PointObservation observation;
  observation.point = point;
  observation.measurement.pixel = {(0.5 + 0.4 * std::cos(turn)) * width, (0.5 + 0.4 * std::sin(turn)) * height};
  observation.measurement.normal = {std::cos(turn), std::sin(turn)};
  observation.measurement.sigma_normal = 0.1 + 0.01 * keyframe;
  observation.measurement.sigma_tangent = 1000.0 / 3;
  observation.bearing = Eigen::Vector3d(0.3 * std::cos(turn), 0.3 * std::sin(turn), 1).normalized();
  observation.corner = point % 2 == 0;
  observation.chain = point == 2 ? -1 : static_cast<int>(point % 100);
  observation.order = 2 * static_cast<int>(point % 100);
  return observation;
}

inline SeenEdge madeEdge(LineId line, int width, int height) {
  const PointObservation from = madeObservation(7, 1, width, height), to = madeObservation(8, 1, width, height);
  return {line, {from.measurement.pixel, from.bearing}, {to.measurement.pixel, to.bearing}, 1e-4 / 3};
}

// Keyframes 0, 1, 4 and 9, of which 0 and 4 have images; points 2, 3, 5 and 40000000000. Point 2 is a track without a
// depth. Line 3, which keyframes 0 and 4 see, is placed, line 8 is not. Its scale is known by inertia, and by
// wheels.
inline SavedMap madeMap(int width, int height) {
  SavedMap saved;
  saved.camera.model = CameraModel::kannala_brandt;
  saved.camera.width = width;
  saved.camera.height = height;
  saved.camera.fx = saved.camera.fy = 0.7 * width;
  saved.camera.cx = 0.5 * width - 1.0 / 3;
  saved.camera.cy = 0.5 * height;
  saved.camera.distortion = {-0.01, 1e-300, -0.0, 0.25, 0};
  saved.camera.readout_s = 0.1 / 3;
  const PointId large = 40'000'000'000;
  for (const KeyframeId id : {0, 1, 4, 9}) {
    Keyframe keyframe;
    keyframe.id = id;
    keyframe.frame_index = 31 * id;
    keyframe.time_ns = 1'700'000'000'000'000'000 + 33'333'333 * id;
    keyframe.world_T_camera.rotation = Eigen::Quaterniond(0.9, 0.1 * id, -0.2, 0.3).normalized();
    keyframe.world_T_camera.translation = {0.1 * id, -0.0, 5e-324};
    keyframe.twist << 0.01 * id, -0.0, 1.0 / 3, 5e-324, -0.3, 1e-5;
    keyframe.reason = id == 0 ? "" : "rotation by 12 deg";
    for (const PointId point : {PointId{2}, PointId{3}, PointId{5}, large}) {
      if (id == 9 && point == 3) continue;
      PointObservation observation = madeObservation(point, id, width, height);
      observation.straight_edge = id == 4 && point == 3 ? 1 : -1;
      keyframe.observations.push_back(observation);
    }
    if (id == 0 || id == 4) keyframe.straight_edges.push_back(madeEdge(3, width, height));
    if (id == 4) keyframe.straight_edges.push_back(madeEdge(8, width, height));
    if (id == 9) keyframe.straight_edges.push_back(madeEdge(-1, width, height));
    if (id == 0 || id == 4) keyframe.images = madeImages(width, height, id == 0 ? 6 : 2, id);
    saved.map.keyframes.push_back(keyframe);
  }
  for (const PointId id : {PointId{3}, PointId{5}, large}) {
    MapPoint point;
    point.id = id;
    point.host = 4;
    point.host_bearing = madeObservation(id, 4, width, height).bearing;
    point.inverse_depth = 1.0 / 3;
    point.inverse_depth_sigma = id == 5 ? 0 : 0.1;
    point.corner = id == 5;
    point.chain_keyframe = 2;  // culled since
    point.chain = 17;
    point.order = 5;
    if (id == 5) point.seen_in = {0, 1, 9};
    if (id == large) point.seen_in = {9};
    saved.map.points.emplace(id, point);
  }
  saved.map.lines.emplace(
      3, MapLine{3, 4, {{1.0 / 3, -0.0, 5e-324}, Eigen::Vector3d(1, -2, 3).normalized()}, true, -0.1, 1.0 / 3, {0, 4}});
  saved.map.lines.emplace(8, MapLine{8, 4, {}, false, 0, 0, {4}});
  saved.map.next_line = 12;
  InertialAlignment& alignment = saved.map.inertia[0];
  alignment.is_known = true;
  alignment.metres_a_unit = 1.0 / 3;
  alignment.scale_sigma = 0.1 / 3;
  alignment.gravity = standard_gravity * Eigen::Vector3d(0.1, 1, -0.2).normalized();
  saved.map.wheels[0] = {true, 1.0 / 7, 0.01 / 3};
  return saved;
}

inline Keyframe& keyframeOf(SavedMap& saved, KeyframeId id) { return saved.map.keyframes[id]; }

}  // namespace edgeslam::test
