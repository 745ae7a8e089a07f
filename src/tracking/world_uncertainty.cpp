#include "tracking/world_uncertainty.h"

#include <cassert>

namespace edgeslam {
namespace {

double squared(double value) { return value * value; }

}  // namespace

Matrix6d mapUncertaintyAt(const MapView& view, const std::vector<Track>& tracks, const Pose& world_T_camera,
                          std::pmr::memory_resource* memory) {
  assert(view.keyframes.size() > 0);
  std::pmr::vector<int> points_of(view.keyframes.size(), 0, memory);
  AscendingPoints points(view);
  std::size_t most = view.keyframes.size() - 1;
  for (const Track& track : tracks) {
    const ViewPoint* point = points.find(track.id);
    if (!point) continue;
    const std::size_t place = view.keyframes.placeOf(point->host);
    if (++points_of[place] > points_of[most]) most = place;
  }
  const ViewKeyframe& keyframe = view.keyframes.atPlace(most);
  return carriedUncertainty(keyframe.uncertainty, keyframe.world_T_camera.inverse() * world_T_camera)
      .topLeftCorner<6, 6>();
}

Matrix6d worldCovariance(const Camera& camera, const Matrix6d& covariance, const Matrix6d& map_covariance,
                         double outlier_share, const WorldUncertaintyOptions& options) {
  const double contradiction = 1 + squared(outlier_share / options.doubling_outlier_share);
  Matrix6d sum = squared(options.correlation_factor) * contradiction * covariance + map_covariance;
  sum.diagonal().tail<3>().array() += squared(options.calibration_sigma / meanFocalLength(camera));
  return sum;
}

}  // namespace edgeslam
