#include "mapping/line_association.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "map/worlds.h"
#include "mapping/line_views.h"

namespace edgeslam {
namespace {

constexpr double least_cosine = 0.9;  // between the planes of a line's projection and of an edge

// By track: the line that it was seen on last, in some keyframes before one.
std::map<PointId, LineId> latestLines(const LineOptions& options, const Map& map, KeyframeId keyframe) {
  std::vector<KeyframeId> recent;
  for (KeyframeId id = keyframeBefore(map, keyframe);
       id >= 0 && static_cast<int>(recent.size()) < options.recent_keyframes; id = keyframeBefore(map, id)) {
    recent.push_back(id);
  }
  std::map<PointId, LineId> latest;
  for (std::size_t k = recent.size(); k-- > 0;) {
    const Keyframe& before = map.keyframes[recent[k]];
    for (const PointObservation& seen : before.observations) {
      const LineId line = lineOf(before, seen);
      if (line >= 0) latest[seen.point] = line;
    }
  }
  return latest;
}

using Votes = std::map<LineId, int>;

// Of the tracks on each straight edge of a keyframe.
std::vector<Votes> votesOf(const std::map<PointId, LineId>& latest, const Keyframe& keyframe) {
  std::vector<Votes> votes(keyframe.straight_edges.size());
  for (const PointObservation& seen : keyframe.observations) {
    const auto found = latest.find(seen.point);
    if (seen.straight_edge < 0 || found == latest.end()) continue;
    ++votes[static_cast<std::size_t>(seen.straight_edge)][found->second];
  }
  return votes;
}

// What enough tracks, and half of those that were seen on lines, say.
std::optional<LineId> elected(const LineOptions& options, const Votes& votes) {
  int all = 0;
  for (const auto& [line, count] : votes) all += count;
  for (const auto& [line, count] : votes) {
    if (count >= options.fewest_votes && 2 * count >= all) return line;
  }
  return std::nullopt;
}

// How far a placed line projects from an edge, the larger of its ends [rad]; infinite where the brighter side is the
// other one, or what is known of the line is elsewhere.
double misfit(const Camera& camera, const Map& map, const MapLine& line, const Keyframe& keyframe,
              const SeenEdge& edge) {
  constexpr double never = std::numeric_limits<double>::infinity();
  const SpaceLine in_world = inWorld(map, line);
  const EdgePlane plane = edgePlane(camera, keyframe, edge);
  const Eigen::Vector3d normal = normalSeenFrom(in_world, plane.centre);
  if (!(normal.dot(plane.normal) > least_cosine)) return never;
  // Half of its length beyond what was seen before it is still the same.
  const Extent seen = extentOf(camera, in_world, keyframe, edge);
  const double beyond = 0.5 * (line.end - line.begin);
  if (!(seen.begin <= seen.end) || seen.end < line.begin - beyond || seen.begin > line.end + beyond) return never;
  return std::max(std::abs(normal.dot(worldRay(camera, keyframe, edge.from).direction)),
                  std::abs(normal.dot(worldRay(camera, keyframe, edge.to).direction)));
}

// The placed line that projects onto an edge, if no other one does nearly as well.
std::optional<LineId> projectedOnto(const Camera& camera, const LineOptions& options, const Map& map,
                                    const Keyframe& keyframe, const SeenEdge& edge) {
  std::optional<LineId> nearest;
  double least = options.largest_misfit / meanFocalLength(camera), second = std::numeric_limits<double>::infinity();
  for (const auto& [id, line] : map.lines) {
    if (!line.is_placed || map.keyframes[line.host].world != keyframe.world) continue;
    const double off = misfit(camera, map, line, keyframe, edge);
    if (off < least) {
      if (nearest) second = least;
      least = off;
      nearest = id;
    } else {
      second = std::min(second, off);
    }
  }
  if (second <= 2 * least) return std::nullopt;
  return nearest;
}

LineId beginLine(KeyframeId host, Map& map) {
  MapLine line;
  line.id = map.next_line++;
  line.host = host;
  map.lines.emplace(line.id, line);
  return line.id;
}

}  // namespace

void associateLines(const Camera& camera, const LineOptions& options, KeyframeId id, Map& map) {
  Keyframe& keyframe = map.keyframes[id];
  if (keyframe.straight_edges.empty()) return;
  const std::vector<Votes> votes = votesOf(latestLines(options, map, id), keyframe);
  for (std::size_t i = 0; i < keyframe.straight_edges.size(); ++i) {
    SeenEdge& edge = keyframe.straight_edges[i];
    std::optional<LineId> line = elected(options, votes[i]);
    if (!line) line = projectedOnto(camera, options, map, keyframe, edge);
    edge.line = line ? *line : beginLine(id, map);
    std::vector<KeyframeId>& seen_in = map.lines.at(edge.line).seen_in;
    if (seen_in.empty() || seen_in.back() != id) seen_in.push_back(id);
  }
}

}  // namespace edgeslam
