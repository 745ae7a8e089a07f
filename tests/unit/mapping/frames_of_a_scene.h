// Tracked frames of scenes whose points are known, and paths before them.
#pragma once

#include <vector>

#include "mapping/initial_frames.h"
#include "mapping/initial_structure.h"
#include "unit/mapping/edge_scene.h"

namespace edgeslam::test {

inline TrackedFrame seen(const Camera& camera, const EdgeScene& scene, const Pose& world_T_camera,
                         std::int64_t frame_index, KeyframeId keyframe) {
  Random random(1);
  TrackedFrame frame;
  frame.frame_index = frame_index;
  frame.time_ns = 33'333'333 * frame_index;
  frame.world_T_camera = world_T_camera;
  frame.observations = observeAll(camera, scene, world_T_camera, Sight(), random);
  frame.kind = keyframe == 0 ? FrameKind::first : keyframe < 0 ? FrameKind::start : FrameKind::keyframe;
  frame.keyframe = keyframe;
  frame.reason = "interval";
  return frame;
}

// Keyframes at these poses with all points that two of them see.
inline Map mapFrom(const Camera& camera, const EdgeScene& scene, const std::vector<Pose>& poses) {
  Random random(2);
  Map map = keyframesOf(camera, scene, poses, Sight(), random);
  addAllPoints(scene, map);
  return map;
}

inline Pose at(double x, double y = 0, double turn = 0) { return {rotationExp({0, turn, 0}), {x, y, 0}}; }

inline std::vector<Pose> row(int count, double spacing) {
  std::vector<Pose> poses;
  for (int k = 0; k < count; ++k) poses.push_back(at(spacing * k));
  return poses;
}

// A wall along x so long that its ends never are in view together.
inline EdgeScene longWall(double length, int count) {
  Random random(3);
  EdgeScene scene;
  for (int i = 0; i < count; ++i) {
    const double x = length * (i + uniform(random, 0, 1)) / count - 3;
    scene.points.push_back({{x, uniform(random, -2, 2), uniform(random, 4, 6)}, direction(random), i, 0, true});
  }
  return scene;
}

// What a map may be started from: measured at these poses without error, the first of which is the origin.
inline InitialFrames initialFrames(const Camera& camera, const EdgeScene& scene, const std::vector<Pose>& poses) {
  InitialFrames frames;
  frames.first = seen(camera, scene, poses.front(), 0, 0);
  for (std::size_t k = 1; k < poses.size(); ++k)
    addFrame(frames, seen(camera, scene, poses[k], static_cast<std::int64_t>(k), -1));
  return frames;
}

// The scene as it is, seen from `first_T_camera`, the poses of the frames since the first that have these indices.
// Depths are known to a twentieth.
inline InitialStructure trueStructure(const EdgeScene& scene, const InitialFrames& frames,
                                      const std::vector<std::size_t>& indices,
                                      const std::vector<Pose>& first_T_camera) {
  InitialStructure structure;
  structure.frames = indices;
  structure.first_T_camera = first_T_camera;
  for (const PointObservation& observation : frames.first.observations) {
    structure.inverse_depths.push_back(1 / scene.points[static_cast<std::size_t>(observation.point)].position.norm());
    structure.depth_sigmas.push_back(0.05 * structure.inverse_depths.back());
  }
  return structure;
}

inline double distance(const Pose& a, const Pose& b) { return (a.translation - b.translation).norm(); }

}  // namespace edgeslam::test
