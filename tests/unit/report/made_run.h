// A run made by hand: a camera on a helix before straight edges, some frames without a pose.
#pragma once

#include <cmath>
#include <opencv2/core.hpp>

#include "evaluation/trajectory.h"
#include "pipeline/run_result.h"
#include "report/run_description.h"

namespace edgeslam {

constexpr int made_frames = 120;
constexpr int made_lines = 8;
constexpr int made_points_per_line = 25;
constexpr int made_initialising_frames = 10;
constexpr int made_lost_frame = 60;

// In metres, z up, looking along y; the true way of the made run.
inline Trajectory madeGroundTruth() {
  Eigen::Matrix3d forward;  // camera axes in the columns
  forward << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  Trajectory truth;
  for (int i = 0; i < made_frames; ++i) {
    const double angle = 0.1 * i;
    const Eigen::Vector3d position(std::cos(angle), std::sin(angle), 1 + 0.01 * i);
    const Pose pose{Eigen::Quaterniond(forward) * rotationExp({0.1 * std::sin(angle), 0.05 * angle, 0}), position};
    truth.push_back({1000000000123456789 + i * std::int64_t{33333333}, pose});
  }
  return truth;
}

// Exact but for its unit, half a metre, and its frame, that of the camera at the first final pose.
inline RunResult makeRun() {
  const Trajectory truth = madeGroundTruth();
  const Pose world_T_reference = truth[made_initialising_frames].world_T_camera.inverse();
  const auto inWorld = [&](const Pose& pose) {
    Pose moved = world_T_reference * pose;
    moved.translation *= 2;
    return moved;
  };
  RunResult run;
  run.camera.width = 640, run.camera.height = 480;
  run.camera.fx = run.camera.fy = 525, run.camera.cx = 319.5, run.camera.cy = 239.5;
  for (int i = 0; i < made_frames; ++i) {
    FrameRecord frame;
    frame.index = i;
    frame.time_ns = truth[static_cast<std::size_t>(i)].time_ns;
    const bool initialising = i < made_initialising_frames;
    frame.state = initialising           ? TrackingState::initialising
                  : i == made_lost_frame ? TrackingState::lost
                                         : TrackingState::tracking;
    if (initialising) frame.reason = "too little parallax, \"0.4\" of 1.5 degrees";
    frame.has_pose = frame.has_final_pose = frame.state == TrackingState::tracking;
    frame.world = frame.final_world = frame.has_pose ? 0 : -1;
    frame.world_T_camera = frame.final_world_T_camera = inWorld(truth[static_cast<std::size_t>(i)].world_T_camera);
    frame.world_covariance.diagonal().setConstant(1e-4);
    frame.tracked_points = 300 + i, frame.mapped_points = 200 + i;
    frame.is_keyframe = frame.has_final_pose && i % 20 == 10;
    frame.times.add(Stage::edges, 5);
    frame.times.add(Stage::flow, 1 + 0.01 * i);
    if (frame.is_keyframe) {
      frame.times.add(Stage::mapping, 40);
      run.keyframes.push_back({static_cast<int>(run.keyframes.size()), 0, frame.index, frame.time_ns,
                               frame.final_world_T_camera, "one second since the last", 120});
    }
    run.frames.push_back(frame);
  }
  for (int line = 0; line < made_lines; ++line) {
    for (int k = 0; k < made_points_per_line; ++k) {
      MapPointRecord point;
      point.position = 2 * (world_T_reference * Eigen::Vector3d(0.5 * line - 2, 4, 0.05 * k));
      point.edge_direction = world_T_reference.rotation * Eigen::Vector3d::UnitZ();
      point.chain = line;
      point.order = 6 * k;
      point.depth_sigma_ratio = 0.02F;
      point.grey = static_cast<unsigned char>(20 * line);
      run.map_points.push_back(point);
    }
  }
  run.drawings.push_back({20, cv::Mat(48, 64, CV_8UC3, cv::Scalar(60, 120, 180))});
  run.initialisation = "flat depth over frames 1 to 10";
  run.wall_s = 2;
  return run;
}

inline RunDescription describeMadeRun() {
  RunDescription description;
  description.input = "/recordings/helix";
  description.sequence = "helix";
  description.program_version = "1.2.3";
  description.library_versions = {{"OpenCV", "4.6.0"}};
  description.configuration = "edges:\n  sigma: 1.78\n";
  description.command_line = "edgeslam replay /recordings/helix";
  return description;
}

}  // namespace edgeslam
