#include "pipeline/frame_look.h"

#include <algorithm>

namespace edgeslam {
namespace {

// Every other point is enough for lines, and leaves most edges two points at least.
constexpr std::size_t usual_stride = 2;

void fillTracks(const Tracker& tracker, std::vector<SeenTrack>& seen) {
  AscendingPoints points(tracker.view());
  for (const Track& track : tracker.tracks()) {
    if (seen.size() == most_seen_tracks) return;
    const bool mapped = tracker.view().initialised && points.find(track.id) != nullptr;
    seen.push_back(
        {track.pixel, track.last_keyframe_pixel, track.normal, track.corner, mapped, track.outlier_frames > 0});
  }
}

void fillEdges(const EdgeMap& edges, std::vector<SeenEdgePoint>& seen) {
  const std::size_t count = edges.points.size();
  const std::size_t stride = std::max(usual_stride, (count + most_seen_edge_points - 1) / most_seen_edge_points);
  for (std::size_t i = 0; i < count; i += stride) seen.push_back({edges.points[i].pixel, edges.points[i].chain});
}

}  // namespace

FrameLooks::FrameLooks() {
  for (int i = 0; i < 3; ++i) {
    looks_.writing().tracks.reserve(most_seen_tracks);
    looks_.writing().edges.reserve(most_seen_edge_points);
    looks_.publish();
    looks_.take();
  }
}

void FrameLooks::fill(const FrameResult& result, const Tracker& tracker, FrameLook& look) {
  look.index = result.index;
  look.time_ns = result.time_ns;
  look.state = result.state;
  look.images = tracker.latestImages();
  look.tracks.clear();
  look.edges.clear();
  if (tracker.latestIsTracked()) fillTracks(tracker, look.tracks);
  if (const EdgeMap* edges = tracker.latestEdges()) fillEdges(*edges, look.edges);
}

}  // namespace edgeslam
