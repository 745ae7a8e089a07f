// A textured plane seen by a camera, rendered exactly for any pose; and what tracking knows of it.
#pragma once

#include <memory>

#include "geometry/camera.h"
#include "map/map_view.h"
#include "tracking/track.h"
#include "unit/flow/smooth_texture.h"

namespace edgeslam {

inline Camera smallCamera() {
  return {CameraModel::pinhole_radial_tangential, 320, 240, 260, 262, 161, 118, {-0.08, 0.02, 0.001, -0.0005, 0}};
}

// The plane z = distance of the world. Its texture is drawn in units of a camera's pixels there, times `grain`.
struct TexturedPlane {
  SmoothTexture texture;
  double distance = 2;
  double grain = 1;

  Eigen::Vector3d seenAt(const Camera& camera, const Pose& world_T_camera, const Eigen::Vector2d& pixel) const {
    const Eigen::Vector3d ray = world_T_camera.rotation * bearing(camera, pixel);
    return world_T_camera.translation + (distance - world_T_camera.translation.z()) / ray.z() * ray;
  }

  cv::Mat render(const Camera& camera, const Pose& world_T_camera) const {
    const double pixels = camera.fx / distance / grain;
    return texture.render({camera.width, camera.height}, [&](const Eigen::Vector2d& pixel) -> Eigen::Vector2d {
      return pixels * seenAt(camera, world_T_camera, pixel).head<2>();
    });
  }
};

inline std::shared_ptr<const FrameImages> imagesOf(const cv::Mat& grey, std::int64_t frame_index = 0) {
  auto images = std::make_shared<FrameImages>();
  images->frame_index = frame_index;
  images->pyramid = buildPyramid(grey, 4);
  return images;
}

inline Track trackAt(PointId id, const Eigen::Vector2f& pixel, const Eigen::Vector2f& normal = {1, 0}) {
  Track track;
  track.id = id;
  track.pixel = track.keyframe_pixel = track.last_keyframe_pixel = pixel;
  track.normal = normal.normalized();
  return track;
}

// A map point of `view`, hosted in its keyframe `host`, at a place in the world.
inline ViewPoint viewPoint(const MapView& view, PointId id, KeyframeId host, const Eigen::Vector3d& position) {
  const Eigen::Vector3d in_host = view.keyframes[host].world_T_camera.inverse() * position;
  ViewPoint point;
  point.id = id;
  point.host = host;
  point.host_bearing = in_host.normalized();
  point.inverse_depth = 1 / in_host.norm();
  point.inverse_depth_sigma = 0.01 * point.inverse_depth;
  return point;
}

}  // namespace edgeslam
