#include "places/guided_matching.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "flow/patch_alignment.h"
#include "geometry/angles.h"
#include "geometry/camera_mask.h"
#include "places/place_view.h"
#include "tracking/patch_refinement.h"

namespace edgeslam {
namespace {

// The keyframe, among those that see a point and have images, from where it is seen most like from `centre` (world
// frame): at the smallest angle, of those within a few degrees the one at the most similar distance. -1 where there is
// none within the largest angle.
KeyframeId bestSourceOfPatch(const Map& map, const MapPoint& point, const Eigen::Vector3d& centre,
                             double largest_angle_deg) {
  const Eigen::Vector3d position = worldPosition(map, point);
  const Eigen::Vector3d wanted = position - centre;
  KeyframeId best = -1;
  double least = 1e300;
  const auto judge = [&](KeyframeId keyframe) {
    const Keyframe& candidate = keyframeOf(map, keyframe);
    if (!candidate.images || !findObservation(candidate, point.id)) return;
    const Eigen::Vector3d ray = position - candidate.world_T_camera.translation;
    const double cosine = ray.dot(wanted) / (ray.norm() * wanted.norm());
    const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
    if (!(degrees(angle) < largest_angle_deg)) return;
    const double cost = angle + 0.5 * std::abs(std::log(ray.norm() / wanted.norm()));
    if (cost < least) {
      least = cost;
      best = keyframe;
    }
  };
  judge(point.host);
  for (const KeyframeId keyframe : point.seen_in) judge(keyframe);
  return best;
}

// Aligns the warped patch from coarse to fine. False where it is not found.
bool align(const ImagePyramid& source, const Eigen::Vector2f& source_pixel, const Eigen::Matrix2f& warp,
           const ImagePyramid& target, const GuidedMatchingOptions& options, Eigen::Vector2f& pixel) {
  const float size = std::abs(warp.determinant());
  if (!(size > 0.06f && size < 16.0f)) return false;
  AlignmentOptions alignment;
  alignment.iterations = options.iterations;
  alignment.damping = static_cast<float>(options.damping);
  const int source_levels = static_cast<int>(source.levels.size()),
            target_levels = static_cast<int>(target.levels.size());
  // A patch seen from farther away now than then is read from a smaller image of then, so that it is not undersampled.
  const int shrink = std::clamp(static_cast<int>(std::lround(0.5 * std::log2(size))), 0, source_levels - 1);
  for (int level = std::min(1, target_levels - 1); level >= 0; --level) {
    const int source_level = std::min(level + shrink, source_levels - 1);
    const float source_scale = std::ldexp(1.0f, -source_level), target_scale = std::ldexp(1.0f, -level);
    PatchTemplate patch;
    const Eigen::Matrix2f level_warp = warp * (source_scale / target_scale);
    if (!makeTemplate(source.levels[static_cast<std::size_t>(source_level)], source_pixel * source_scale, level_warp,
                      options.window, patch)) {
      return false;
    }
    const Eigen::Vector2f start = pixel * target_scale;
    const AlignmentResult aligned =
        alignPatch(patch, target.levels[static_cast<std::size_t>(level)], start, start, alignment);
    if (!aligned.inside) return false;
    if (level > 0 && aligned.correlation < 0.6f) continue;  // the finer level starts from the prediction
    if (level == 0 && aligned.correlation < static_cast<float>(options.least_correlation)) return false;
    pixel = aligned.pixel / target_scale;
  }
  return true;
}

// The map point of `view` on the same piece of edge as a measurement, nearest across the edge, or -1.
int partnerOf(const PlaceView& view, const Measurement& measured, const GuidedMatchingOptions& options) {
  int best = -1;
  double least = options.partner_across;
  for (std::size_t j = 0; j < view.points.size(); ++j) {
    const Measurement& other = view.points[j].measurement;
    const Eigen::Vector2d apart = measured.pixel - other.pixel;
    if (apart.squaredNorm() > options.partner_along * options.partner_along) continue;
    if (other.normal.dot(measured.normal) < 0.8) continue;
    const double across = std::abs(other.normal.dot(apart));
    if (across < least) {
      least = across;
      best = static_cast<int>(j);
    }
  }
  return best;
}

}  // namespace

bool findByPatch(const Camera& camera, const Map& map, const PlaceView& from, const PlacePoint& point,
                 const Pose& camera_T_from, const FrameImages& images, double largest_move,
                 const GuidedMatchingOptions& options, Measurement& predicted) {
  const MapPoint& map_point = map.points.at(point.id);
  const Pose& world_T_from = keyframeOf(map, from.keyframe).world_T_camera;
  const Pose world_T_camera = world_T_from * camera_T_from.inverse();
  const KeyframeId source =
      bestSourceOfPatch(map, map_point, world_T_camera.translation, options.largest_view_angle_deg);
  if (source < 0) return false;
  const Keyframe& keyframe = keyframeOf(map, source);
  const Eigen::Vector2f source_pixel = findObservation(keyframe, point.id)->measurement.pixel.cast<float>();
  const double depth = (worldPosition(map, map_point) - keyframe.world_T_camera.translation).norm();
  const Eigen::Matrix2f warp =
      keyframeWarp(camera, world_T_camera.inverse() * keyframe.world_T_camera, source_pixel, depth);
  Eigen::Vector2f pixel = predicted.pixel.cast<float>();
  if (!warp.allFinite() || !align(keyframe.images->pyramid, source_pixel, warp, images.pyramid, options, pixel)) {
    return false;
  }
  const Eigen::Vector2d moved = pixel.cast<double>() - predicted.pixel;
  const double along_limit = point.corner ? largest_move : 2 * largest_move;
  const Eigen::Vector2d tangent(-predicted.normal.y(), predicted.normal.x());
  if (std::abs(predicted.normal.dot(moved)) > largest_move || std::abs(tangent.dot(moved)) > along_limit) return false;
  predicted.pixel = pixel.cast<double>();
  return isLookedAt(camera, predicted.pixel, image_border);
}

GuidedMatches matchGuided(const Camera& camera, const Map& map, const PlaceView& from, const PlaceView& to,
                          const Similarity& to_S_from, double largest_move, const GuidedMatchingOptions& options) {
  GuidedMatches found;
  if (!to.images) return found;
  const Pose to_T_from = upToScale(to_S_from);
  const Eigen::Vector3d centre = to_T_from.inverse().translation;
  const double least_cosine = std::cos(radians(options.largest_view_angle_deg));
  GuidedMatchingOptions wide = options;
  wide.partner_across += largest_move;
  for (std::size_t i = 0; i < from.points.size(); ++i) {
    const PlacePoint& point = from.points[i];
    GuidedMatch match;
    if (!predictMeasurement(camera, to_T_from, point.position, point.measurement, match.measurement)) continue;
    if (!isLookedAt(camera, match.measurement.pixel, image_border)) continue;
    const Eigen::Vector3d ray = point.position - centre;
    if (ray.dot(point.position) < least_cosine * ray.norm() * point.position.norm()) continue;
    ++found.visible;
    if (partnerOf(to, match.measurement, wide) >= 0) ++found.visible_in_both;
    if (!findByPatch(camera, map, from, point, to_T_from, *to.images, largest_move, options, match.measurement))
      continue;
    match.from = static_cast<int>(i);
    match.to = partnerOf(to, match.measurement, options);
    found.matches.push_back(match);
  }
  return found;
}

}  // namespace edgeslam
