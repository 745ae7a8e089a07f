#include "mapping/line_placement.h"

#include <cmath>
#include <optional>
#include <vector>

#include "geometry/angles.h"
#include "geometry/median.h"
#include "mapping/line_bundle.h"
#include "mapping/line_views.h"

namespace edgeslam {
namespace {

constexpr std::size_t keyframes_out_of_sight = 4;
constexpr BundleOptions placement_adjustment{20, 2.0};
constexpr double least_agreement = 0.8;  // of the mean of the views' sides: all see the brighter side on the same one

// Where the planes of the two views meet that differ most; nothing where all differ too little.
std::optional<SpaceLine> wherePlanesMeet(const std::vector<EdgePlane>& planes, double least_parallax_deg) {
  double cosine = std::cos(radians(least_parallax_deg));
  const EdgePlane *first = nullptr, *second = nullptr;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double between = std::abs(planes[i].normal.dot(planes[j].normal));
      if (!(between < cosine)) continue;
      cosine = between;
      first = &planes[j];
      second = &planes[i];
    }
  }
  if (!first) return std::nullopt;
  const double distance = second->normal.dot(second->centre - first->centre) / second->normal.dot(first->middle);
  if (!(distance > 0) || !std::isfinite(distance)) return std::nullopt;
  return SpaceLine{first->centre + distance * first->middle, first->normal.cross(second->normal).normalized()};
}

// In front of all that see it, the brighter side where they see it; turned round for that, if need be.
bool isWhereItIsSeen(const std::vector<EdgePlane>& planes, SpaceLine& line) {
  double sides = 0;
  for (const EdgePlane& plane : planes) {
    if (!(distanceAlongRay(line, plane.centre, plane.middle) > 0)) return false;
    sides += normalSeenFrom(line, plane.centre).dot(plane.normal);
  }
  if (sides < 0) line.direction = -line.direction;
  return std::abs(sides) > least_agreement * static_cast<double>(planes.size());
}

std::optional<SpaceLine> placeOf(const Camera& camera, const LineOptions& options, const Map& map,
                                 const MapLine& line) {
  std::vector<EdgePlane> planes;
  BundleProblem problem;
  for (const KeyframeId id : line.seen_in) {
    const Keyframe& keyframe = map.keyframes[id];
    problem.cameras.push_back({keyframe.world_T_camera, true, keyframe.twist});
    for (const SeenEdge& edge : keyframe.straight_edges) {
      if (edge.line != line.id) continue;
      planes.push_back(edgePlane(camera, keyframe, edge));
      addEnds(edge, static_cast<int>(problem.cameras.size()) - 1, 0, problem);
    }
  }
  const std::optional<SpaceLine> start = wherePlanesMeet(planes, options.least_parallax_deg);
  if (!start) return std::nullopt;
  problem.lines.push_back({*start, false});
  const BundleResult result = adjustBundle(camera, problem, placement_adjustment);
  SpaceLine& placed = problem.lines.front().line;
  if (!result.usable || !isWhereItIsSeen(planes, placed)) return std::nullopt;
  if (!(upperMedian(std::vector<double>(result.line_errors)) < options.largest_error)) return std::nullopt;
  return placed;
}

}  // namespace

void placeLines(const Camera& camera, const LineOptions& options, Map& map) {
  std::vector<LineId> forgotten;
  for (auto& [id, line] : map.lines) {
    if (line.is_placed) continue;
    if (static_cast<int>(line.seen_in.size()) >= options.fewest_keyframes) {
      if (const std::optional<SpaceLine> place = placeOf(camera, options, map, line)) {
        setInWorld(*place, map, line);
        line.is_placed = true;
        renewExtent(camera, map, line);
        continue;
      }
    }
    if (map.keyframes.placeOf(line.seen_in.back()) + keyframes_out_of_sight < map.keyframes.size()) {
      forgotten.push_back(id);
    }
  }
  for (const LineId id : forgotten) dissolveLine(id, map);
}

}  // namespace edgeslam
