#include "tracking/edge_tracks.h"

#include <Eigen/Geometry>

namespace edgeslam {
namespace {

constexpr float nearest_radius = 2;       // [px]
constexpr float least_normal_dot = 0.9F;  // of the normals of a track and the edge
constexpr int fewest_tracks = 3;
// Nearer to an end than this, where the edge meets others, a point is known along the edge as well, and no point of a
// line only.
constexpr int end_margin = 8;  // [px]
// A line through a hundred edge points errs less than one of them: on rendered sequences by 0.06 px in the median, and
// 0.2 px at 90 %, where two edges lie side by side.
constexpr double sigma_across = 0.07;  // at each end [px]
constexpr float longest_move = 2;      // [px]

int straightEdgeAt(const EdgeMap& edges, const StraightEdges& straight, const Track& track) {
  const int nearest = nearestEdgePoint(edges, track.pixel, track.normal, nearest_radius, least_normal_dot);
  return nearest < 0 ? -1 : straightEdgeOf(straight, nearest, end_margin);
}

}  // namespace

void putOnStraightEdges(const Camera& camera, const StraightEdges& straight, FollowedFrame& frame) {
  if (straight.empty()) return;
  for (Track& track : frame.tracks) {
    const int index = track.corner ? -1 : straightEdgeAt(*frame.edges, straight, track);
    if (index < 0) continue;
    const StraightEdge& edge = straight[static_cast<std::size_t>(index)];
    const Eigen::Vector3d normal = edge.from_bearing.cross(edge.to_bearing).normalized();
    const Eigen::Vector3d ray = bearing(camera, track.pixel.cast<double>());
    const Eigen::Vector2f there = project(camera, ray - normal.dot(ray) * normal).cast<float>();
    if ((there - track.pixel).norm() < longest_move) track.pixel = there;
  }
}

void keepStraightEdges(const Camera& camera, const StraightEdges& straight, double noise_factor, FollowedFrame& frame,
                       std::pmr::memory_resource* memory) {
  frame.straight_edges.clear();
  for (Track& track : frame.tracks) track.straight_edge = -1;
  if (straight.empty()) return;
  std::pmr::vector<int> tracks(straight.size(), 0, memory), kept(straight.size(), -1, memory);
  for (Track& track : frame.tracks) {
    track.straight_edge = straightEdgeAt(*frame.edges, straight, track);
    if (track.straight_edge >= 0) ++tracks[static_cast<std::size_t>(track.straight_edge)];
  }
  const double sigma = noise_factor * sigma_across / meanFocalLength(camera);
  for (std::size_t i = 0; i < straight.size(); ++i) {
    if (tracks[i] < fewest_tracks) continue;
    kept[i] = static_cast<int>(frame.straight_edges.size());
    const StraightEdge& edge = straight[i];
    frame.straight_edges.push_back({-1, {edge.from, edge.from_bearing}, {edge.to, edge.to_bearing}, sigma});
  }
  for (Track& track : frame.tracks) {
    if (track.straight_edge >= 0) track.straight_edge = kept[static_cast<std::size_t>(track.straight_edge)];
  }
}

}  // namespace edgeslam
