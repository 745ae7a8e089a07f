#include "tracking/patch_refinement.h"

#include <Eigen/LU>
#include <array>
#include <cmath>

#include "geometry/undistortion.h"

namespace edgeslam {
namespace {

enum class Refinement { refined, unchanged, lost };

Refinement refine(const Camera& camera, const MapView& view, const FrameImages& images, const Pose& camera_T_world,
                  const Twist& twist, double scene_depth, const RefinementOptions& options, AscendingPoints& points,
                  Track& track) {
  const ViewKeyframe* keyframe = view.keyframes.find(track.keyframe);
  if (!track.keyframe_images || !keyframe) {
    return Refinement::unchanged;
  }
  const Pose& world_T_keyframe = keyframe->world_T_camera;
  double depth = scene_depth;
  if (const ViewPoint* point = points.find(track.id)) {
    depth = (worldPosition(view, *point) - world_T_keyframe.translation).norm();
  }
  const Eigen::Matrix2f warp =
      keyframeWarp(camera, {camera_T_world * world_T_keyframe, keyframe->twist, twist}, track.keyframe_pixel, depth);
  const float size = warp.determinant();
  if (!(size > 0.2f && size < 5.0f)) return Refinement::lost;

  PatchTemplate patch;
  if (!makeTemplate(track.keyframe_images->pyramid.levels[0], track.keyframe_pixel, warp, options.window, patch)) {
    return Refinement::unchanged;
  }
  AlignmentOptions alignment;
  alignment.iterations = options.iterations;
  alignment.damping = static_cast<float>(options.damping);
  const AlignmentResult aligned = alignPatch(patch, images.pyramid.levels[0], track.pixel, track.pixel, alignment);
  if (!aligned.inside || aligned.correlation < static_cast<float>(options.least_correlation)) return Refinement::lost;
  if (std::abs(track.normal.dot(aligned.pixel - track.pixel)) > static_cast<float>(options.largest_move))
    return Refinement::lost;
  track.pixel = aligned.pixel;
  return Refinement::refined;
}

}  // namespace

Eigen::Matrix2f keyframeWarp(const Camera& camera, const KeyframeToCamera& motion,
                             const Eigen::Vector2f& keyframe_pixel, double depth) {
  constexpr double step = 4;  // [px]
  const Eigen::Vector2d centre = keyframe_pixel.cast<double>(), right(step, 0), down(0, step);
  const std::array<Eigen::Vector2d, 4> around = {centre + right, centre - right, centre + down, centre - down};
  std::array<Eigen::Vector3d, 4> bearings;
  bearingsOf(camera, around.data(), around.size(), bearings.data());
  std::array<Eigen::Vector2d, 4> there;
  for (std::size_t i = 0; i < there.size(); ++i) {
    const Ray ray = rayOfRow(camera, motion.keyframe_twist, around[i].y(), bearings[i]);
    there[i] =
        projectToRow(camera, motion.camera_twist, motion.camera_T_keyframe * (ray.origin + ray.direction * depth));
  }
  Eigen::Matrix2d camera_by_keyframe;
  camera_by_keyframe.col(0) = (there[0] - there[1]) / (2 * step);
  camera_by_keyframe.col(1) = (there[2] - there[3]) / (2 * step);
  return camera_by_keyframe.inverse().cast<float>();
}

void refineTracks(const Camera& camera, const MapView& view, const FrameImages& images, const MovingCamera& moving,
                  double scene_depth, const RefinementOptions& options, std::vector<Track>& tracks) {
  if (!options.enabled) return;
  const Pose camera_T_world = moving.world_T_camera.inverse();
  AscendingPoints points(view);
  std::size_t kept = 0;
  for (Track& track : tracks) {
    if (refine(camera, view, images, camera_T_world, moving.twist, scene_depth, options, points, track) ==
        Refinement::lost)
      continue;
    if (&tracks[kept] != &track) tracks[kept] = std::move(track);
    ++kept;
  }
  tracks.erase(tracks.begin() + static_cast<std::ptrdiff_t>(kept), tracks.end());
}

}  // namespace edgeslam
