#include "tracking/edge_lock.h"

#include <cmath>

#include "geometry/camera_mask.h"

namespace edgeslam {

void lockAlongEdges(const Camera& camera, const MapView& view, const MovingCamera& moving,
                    const EdgeLockOptions& options, std::vector<Track>& tracks) {
  if (!options.enabled) return;
  const Pose camera_T_world = moving.world_T_camera.inverse();
  AscendingPoints points(view);
  for (Track& track : tracks) {
    if (track.corner || track.sigma_normal >= options.straightness * track.sigma_tangent) continue;
    const ViewPoint* point = points.find(track.id);
    if (!point) continue;
    const Eigen::Vector3d in_camera = camera_T_world * worldPosition(view, *point);
    if (in_camera.z() <= 0) continue;
    const Eigen::Vector2f projected = projectToRow(camera, moving.twist, in_camera).cast<float>();
    const Eigen::Vector2f tangent(-track.normal.y(), track.normal.x());
    const float along = tangent.dot(projected - track.pixel);
    if (std::abs(along) > static_cast<float>(options.longest_move)) continue;
    const Eigen::Vector2f moved = track.pixel + along * tangent;
    if (isLookedAt(camera, moved.cast<double>(), 8)) track.pixel = moved;
  }
}

}  // namespace edgeslam
