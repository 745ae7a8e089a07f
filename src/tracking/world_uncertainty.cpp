#include "tracking/world_uncertainty.h"

#include <algorithm>
#include <cassert>

#include "geometry/squared.h"

namespace edgeslam {
namespace {

constexpr double known_as_well = 2.0 / 3;  // share of the points in view

struct HostInView {
  std::size_t place = 0;  // in the view
  int points = 0;         // in view
  double variance = 0;    // the trace of what it leaves open of the camera's pose
};

Matrix6d carriedTo(const Pose& world_T_camera, const ViewKeyframe& keyframe) {
  return carriedUncertainty(keyframe.uncertainty, keyframe.world_T_camera.inverse() * world_T_camera)
      .topLeftCorner<6, 6>();
}

}  // namespace

Matrix6d mapUncertaintyAt(const MapView& view, const std::vector<Track>& tracks, const Pose& world_T_camera,
                          std::pmr::memory_resource* memory) {
  assert(view.keyframes.size() > 0);
  std::pmr::vector<int> points_of(view.keyframes.size(), 0, memory);
  AscendingPoints points(view);
  int in_view = 0;
  for (const Track& track : tracks) {
    const ViewPoint* point = points.find(track.id);
    if (!point) continue;
    ++points_of[view.keyframes.placeOf(point->host)];
    ++in_view;
  }
  std::pmr::vector<HostInView> hosts(memory);
  hosts.reserve(points_of.size());
  for (std::size_t place = 0; place < points_of.size(); ++place) {
    if (points_of[place] == 0) continue;
    hosts.push_back({place, points_of[place], carriedTo(world_T_camera, view.keyframes.atPlace(place)).trace()});
  }
  if (hosts.empty()) return carriedTo(world_T_camera, view.keyframes.back());
  std::sort(hosts.begin(), hosts.end(), [](const HostInView& a, const HostInView& b) {
    return a.variance < b.variance || (a.variance == b.variance && a.place < b.place);
  });
  auto host = hosts.begin();
  for (int known = host->points; known < known_as_well * in_view; known += host->points) ++host;
  return carriedTo(world_T_camera, view.keyframes.atPlace(host->place));
}

Matrix6d worldCovariance(const Camera& camera, const Matrix6d& covariance, const Matrix6d& map_covariance,
                         double outlier_share, const WorldUncertaintyOptions& options) {
  const double contradiction = 1 + squared(outlier_share / options.doubling_outlier_share);
  Matrix6d sum = squared(options.correlation_factor) * contradiction * covariance + map_covariance;
  sum.diagonal().tail<3>().array() += squared(options.calibration_sigma / meanFocalLength(camera));
  return sum;
}

}  // namespace edgeslam
