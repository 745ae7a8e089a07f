#include "tracking/map_search.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "flow/patch_alignment.h"
#include "geometry/angles.h"
#include "geometry/camera_mask.h"
#include "tracking/patch_refinement.h"

namespace edgeslam {
namespace {

// The keyframe's patch as the frame should see it at one of its pyramid levels. The keyframe's level is chosen so that
// the patch is neither enlarged nor skipped over by more than a half.
bool templateAtLevel(const SearchPoint& point, const Eigen::Matrix2f& warp, int level, int window,
                     PatchTemplate& patch) {
  const auto& levels = point.source_images->pyramid.levels;
  const auto shrink = static_cast<int>(std::lround(0.5 * std::log2(std::max(1e-6f, warp.determinant()))));
  const int source_level = std::clamp(level + shrink, 0, static_cast<int>(levels.size()) - 1);
  const float source_scale = std::ldexp(1.0f, -source_level);
  return makeTemplate(levels[static_cast<std::size_t>(source_level)], point.source_pixel * source_scale,
                      warp * std::ldexp(source_scale, level), window, patch);
}

// The start from which the patch matches best: offsets of whole pixels of this level across the edge, both ways for
// corners.
Eigen::Vector2f bestStart(const PatchTemplate& patch, const cv::Mat& image, const Eigen::Vector2f& predicted,
                          const Eigen::Vector2f& normal, bool corner, int reach) {
  Eigen::Vector2f best = predicted;
  float best_correlation = -1;
  const auto consider = [&](const Eigen::Vector2f& start) {
    const float correlation = correlationAt(patch, image, start);
    if (correlation <= best_correlation) return;
    best_correlation = correlation;
    best = start;
  };
  const Eigen::Vector2f along(-normal.y(), normal.x());
  const int reach_along = corner ? reach : 0;
  for (int v = -reach_along; v <= reach_along; ++v) {
    for (int u = -reach; u <= reach; ++u) {
      consider(predicted + static_cast<float>(u) * normal + static_cast<float>(v) * along);
    }
  }
  return best;
}

std::optional<FoundPoint> findPatch(const SearchPoint& point, const VisiblePoint& visible, const FrameImages& current,
                                    const EdgeMap& edges, const MapSearchOptions& options) {
  AlignmentOptions alignment;
  alignment.iterations = options.iterations;
  alignment.damping = static_cast<float>(options.damping);
  const auto& levels = current.pyramid.levels;
  const int coarsest = std::min(options.coarsest_level, static_cast<int>(levels.size()) - 1);
  PatchTemplate patch;
  Eigen::Vector2f pixel = visible.pixel;
  float correlation = -1;
  for (int level = coarsest; level >= 0; --level) {
    if (!templateAtLevel(point, visible.warp, level, options.window, patch)) return std::nullopt;
    const float scale = std::ldexp(1.0f, -level);
    const cv::Mat& image = levels[static_cast<std::size_t>(level)];
    Eigen::Vector2f start = pixel * scale;
    if (level == coarsest) {
      const int reach = static_cast<int>(std::ceil(static_cast<float>(options.radius) * scale));
      start = bestStart(patch, image, start, visible.normal, point.corner, reach);
    }
    const AlignmentResult aligned = alignPatch(patch, image, start, start, alignment);
    if (!aligned.inside) return std::nullopt;
    correlation = aligned.correlation;
    pixel = aligned.pixel / scale;
  }
  const Eigen::Vector2f moved = pixel - visible.pixel;
  const float farthest = point.corner ? moved.norm() : std::abs(visible.normal.dot(moved));
  if (correlation < static_cast<float>(options.least_correlation) ||
      farthest > 1.5f * static_cast<float>(options.radius)) {
    return std::nullopt;
  }
  const float least_dot = point.corner ? -1.0f : static_cast<float>(options.edge_dot);
  if (nearestEdgePoint(edges, pixel, visible.normal, static_cast<float>(options.edge_distance), least_dot) < 0) {
    return std::nullopt;
  }
  return FoundPoint{visible.index, pixel, visible.normal, correlation};
}

}  // namespace

VisiblePoints visiblePoints(const Camera& camera, const SearchPoints& points, const MovingCamera& moving,
                            const MapSearchOptions& options, std::pmr::memory_resource* memory) {
  const Pose& world_T_camera = moving.world_T_camera;
  const Pose camera_T_world = world_T_camera.inverse();
  const double least_cosine = std::cos(radians(options.largest_angle_deg));
  const double largest_area = options.largest_scale * options.largest_scale;
  VisiblePoints visible(memory);
  visible.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const SearchPoint& point = points[i];
    const Eigen::Vector3d from_source = point.position - point.world_T_source.translation;
    const Eigen::Vector3d from_camera = point.position - world_T_camera.translation;
    if (!(from_source.dot(from_camera) > least_cosine * from_source.norm() * from_camera.norm())) continue;
    const Eigen::Vector3d in_camera = camera_T_world * point.position;
    if (!(in_camera.z() > 0.1 * in_camera.norm())) continue;
    const Eigen::Vector2d pixel = projectToRow(camera, moving.twist, in_camera);
    if (!isLookedAt(camera, pixel, options.border)) continue;
    const Eigen::Matrix2f warp =
        keyframeWarp(camera, {camera_T_world * point.world_T_source, point.source_twist, moving.twist},
                     point.source_pixel, from_source.norm());
    const double area = warp.determinant();
    if (!(area * largest_area > 1 && area < largest_area)) continue;
    // A straight line's normal is a covector: n_source . (warp offset) = (warp^T n_source) . offset.
    const Eigen::Vector2f normal = (warp.transpose() * point.source_normal).normalized();
    visible.push_back({i, pixel.cast<float>(), normal, warp});
  }
  return visible;
}

FoundPoints findVisiblePoints(const SearchPoints& points, const VisiblePoints& visible, const FrameImages& current,
                              const EdgeMap& edges, const MapSearchOptions& options,
                              std::pmr::memory_resource* memory) {
  FoundPoints found(memory);
  found.reserve(visible.size());
  for (const VisiblePoint& candidate : visible) {
    const SearchPoint& point = points[candidate.index];
    if (!point.source_images) continue;
    if (const auto match = findPatch(point, candidate, current, edges, options)) found.push_back(*match);
  }
  return found;
}

Measurement measurementOf(const SearchPoint& point, const FoundPoint& found) {
  return {found.pixel.cast<double>(), found.normal.cast<double>(), point.sigma_normal, point.sigma_tangent};
}

}  // namespace edgeslam
