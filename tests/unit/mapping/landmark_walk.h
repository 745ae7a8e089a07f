// Maps of a camera that goes round and round among landmarks.
#pragma once

#include <memory>
#include <vector>

#include "map/map.h"
#include "mapping/new_points.h"
#include "unit/adjustment/synthetic_scene.h"

namespace edgeslam::test {

// A walk on a circle, looking outwards at landmarks all around.
struct Walk {
  static Camera camera() { return testCamera(CameraModel::pinhole_radial_tangential); }

  Random random;
  std::vector<Eigen::Vector3d> landmarks;
  static constexpr int steps_a_lap = 40;
  double largest_roll = 0;  // of the camera, three times to both sides a lap [rad]
  std::shared_ptr<FrameImages> images = std::make_shared<FrameImages>();
  Map map;
  Candidates candidates;
  std::vector<Pose> poses;  // by keyframe number

  explicit Walk(std::uint64_t seed, int count = 240) : random(seed) {
    for (int i = 0; i < count; ++i) {
      const double angle = uniform(random, 0, 2 * M_PI), distance = uniform(random, 5, 8);
      landmarks.emplace_back(distance * std::sin(angle), uniform(random, -2, 2), distance * std::cos(angle));
    }
    images->pyramid = buildPyramid(cv::Mat(camera().height, camera().width, CV_8U, cv::Scalar(100)), 1);
  }

  void step() { stepTo(2 * M_PI * static_cast<double>(poses.size()) / steps_a_lap); }

  void stepTo(double angle) {
    const double roll = largest_roll * std::sin(3 * angle);
    const Pose on_circle{rotationExp({0, angle, 0}) * rotationExp({0, 0, roll}),
                         {2 * std::sin(angle), 0, 2 * std::cos(angle)}};
    Keyframe keyframe;
    keyframe.id = static_cast<KeyframeId>(poses.size());
    keyframe.world_T_camera = perturbed(random, on_circle, 0.05, 0.02);
    keyframe.images = images;
    poses.push_back(keyframe.world_T_camera);
    for (std::size_t i = 0; i < landmarks.size(); ++i) {
      const Eigen::Vector3d seen = keyframe.world_T_camera.inverse() * landmarks[i];
      if (!inFront(camera(), seen) || !insideImage(camera(), project(camera(), seen), 5)) continue;
      PointObservation observation;
      observation.point = static_cast<PointId>(i);
      observation.measurement = {project(camera(), seen), {1, 0}, 0.2, 0.2};
      observation.bearing = seen.normalized();
      observation.corner = true;
      keyframe.observations.push_back(observation);
    }
    map.keyframes.push_back(keyframe);
    associate(map, candidates);
    addNewPoints(camera(), {}, map, candidates);
  }
};

}  // namespace edgeslam::test
