#include "pipeline/metric_result.h"

namespace edgeslam {
namespace {

Similarity metricOf(const InertialAlignment& alignment) {
  return {alignment.metres_a_unit, uprightRotation(alignment), Eigen::Vector3d::Zero()};
}

// Of right-hand updates [translation; rotation].
void scaleCovariance(double factor, Matrix6d& covariance) {
  covariance.topRows<3>() *= factor;
  covariance.leftCols<3>() *= factor;
}

void makeMetric(const Similarity& metric, int world, FrameRecord& frame) {
  if (frame.has_final_pose && frame.final_world == world) {
    frame.final_world_T_camera = moved(metric, frame.final_world_T_camera);
  }
  if (frame.world != world) return;
  frame.world_T_camera = moved(metric, frame.world_T_camera);
  frame.reference_T_camera.translation *= metric.scale;
  frame.previous_T_camera.translation *= metric.scale;
  scaleCovariance(metric.scale, frame.covariance);
  scaleCovariance(metric.scale, frame.world_covariance);
  if (frame.has_odometry) frame.odom_T_camera.translation *= metric.scale;
}

void makeMetric(const Similarity& metric, int world, RunResult& result) {
  for (FrameRecord& frame : result.frames) makeMetric(metric, world, frame);
  for (KeyframeRecord& keyframe : result.keyframes) {
    if (keyframe.world == world) keyframe.world_T_camera = moved(metric, keyframe.world_T_camera);
  }
  for (MapPointRecord& point : result.map_points) {
    if (point.world != world) continue;
    point.position = metric * point.position;
    point.edge_direction = metric.rotation * point.edge_direction;
  }
  for (MapLineRecord& line : result.map_lines) {
    if (line.world != world) continue;
    line.from = metric * line.from;
    line.to = metric * line.to;
  }
  if (world != result.main_world) return;
  for (ClosedLoop& loop : result.closed_loops) {
    for (auto* poses : {&loop.before, &loop.after}) {
      for (TimedPose& pose : *poses) pose.world_T_camera = moved(metric, pose.world_T_camera);
    }
  }
}

}  // namespace

void makeMetric(const Map& map, RunResult& result) {
  for (const auto& [world, alignment] : map.inertia) {
    if (!alignment.is_known) continue;
    result.inertia[world] = alignment;
    makeMetric(metricOf(alignment), world, result);
  }
  for (const auto& [world, scale] : map.wheels) {
    if (!scale.is_known || result.inertia.count(world) > 0) continue;
    result.wheels[world] = scale;
    makeMetric({scale.metres_a_unit, Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero()}, world, result);
  }
}

}  // namespace edgeslam
