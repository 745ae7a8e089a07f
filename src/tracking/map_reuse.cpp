#include "tracking/map_reuse.h"

#include <algorithm>
#include <cmath>

namespace edgeslam {
namespace {

SearchPoint searchPointOf(const MapView& view, const ViewPoint& point) {
  const ViewKeyframe& source = view.keyframes[point.source];
  SearchPoint search;
  search.id = point.id;
  search.position = worldPosition(view, point);
  search.source_images = source.images.get();
  search.world_T_source = source.world_T_camera;
  search.source_twist = source.twist;
  search.source_pixel = point.source_measurement.pixel.cast<float>();
  search.source_normal = point.source_measurement.normal.cast<float>();
  search.corner = point.corner;
  search.sigma_normal = static_cast<float>(point.source_measurement.sigma_normal);
  search.sigma_tangent = static_cast<float>(point.source_measurement.sigma_tangent);
  return search;
}

bool nearTrack(const std::vector<Track>& tracks, const Eigen::Vector2f& pixel, float distance) {
  return std::any_of(tracks.begin(), tracks.end(),
                     [&](const Track& track) { return (track.pixel - pixel).squaredNorm() < distance * distance; });
}

}  // namespace

void compareWithMap(const MapView& view, std::vector<Track>& tracks) {
  for (Track& track : tracks) {
    const ViewPoint* point = findPoint(view, track.id);
    if (!point || point->source < 0) continue;
    track.keyframe = point->source;
    track.keyframe_images = view.keyframes[point->source].images;
    track.keyframe_pixel = point->source_measurement.pixel.cast<float>();
  }
}

std::optional<PointsConfirmed> reuseMapPoints(const Camera& camera, const MapView& view, const FrameImages& images,
                                              const EdgeMap& edges, const MovingCamera& moving, std::size_t most,
                                              const MapReuseOptions& options, std::vector<Track>& tracks,
                                              std::pmr::memory_resource* memory) {
  if (!options.enabled || tracks.size() >= most) return std::nullopt;
  SearchPoints points(memory);
  points.reserve(view.points.size());
  std::size_t t = 0;
  for (const ViewPoint& point : view.points) {
    while (t < tracks.size() && tracks[t].id < point.id) ++t;
    const bool followed = t < tracks.size() && tracks[t].id == point.id;
    if (!followed && point.source >= 0 && view.keyframes[point.source].images)
      points.push_back(searchPointOf(view, point));
  }
  const VisiblePoints visible = visiblePoints(camera, points, moving, options.search, memory);
  const auto confirms = [&](PointId id) {
    const ViewPoint* point = findPoint(view, id);
    return point && point->host + options.confirming_age <= view.keyframes.back().id;
  };
  PointsConfirmed of_map;
  for (const Track& track : tracks) {
    if (!confirms(track.id)) continue;
    ++of_map.expected;
    if (track.outlier_frames == 0) ++of_map.confirmed;
  }
  for (const VisiblePoint& point : visible) of_map.expected += confirms(points[point.index].id) ? 1 : 0;

  const Pose camera_T_world = moving.world_T_camera.inverse();
  const auto by_id = [](const Track& a, const Track& b) { return a.id < b.id; };
  for (const FoundPoint& found : findVisiblePoints(points, visible, images, edges, options.search, memory)) {
    const SearchPoint& point = points[found.index];
    const Measurement measurement = measurementOf(point, found);
    const Eigen::Vector2d error =
        projectToRow(camera, moving.twist, camera_T_world * point.position) - measurement.pixel;
    if (std::abs(measurement.normal.dot(error)) > options.outlier_px) continue;
    if (confirms(point.id)) ++of_map.confirmed;
    if (tracks.size() >= most) continue;
    if (nearTrack(tracks, found.pixel, static_cast<float>(options.spacing))) continue;
    const ViewPoint& view_point = *findPoint(view, point.id);
    Track track;
    track.id = point.id;
    track.pixel = track.last_keyframe_pixel = found.pixel;
    track.normal = found.normal;
    track.corner = point.corner;
    track.sigma_normal = static_cast<float>(measurement.sigma_normal);
    track.sigma_tangent = static_cast<float>(measurement.sigma_tangent);
    track.keyframe = view_point.source;
    track.keyframe_images = view.keyframes[view_point.source].images;
    track.keyframe_pixel = point.source_pixel;
    tracks.insert(std::upper_bound(tracks.begin(), tracks.end(), track, by_id), track);
  }
  return of_map;
}

}  // namespace edgeslam
