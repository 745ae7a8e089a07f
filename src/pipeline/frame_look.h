// What tracking saw in a frame, for a person who looks on: the newest frame only, and only when one was asked for. A
// frame that nobody asked for costs tracking the reading of one atomic.
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "pipeline/triple_buffer.h"
#include "tracking/frame_result.h"
#include "tracking/tracker.h"

namespace edgeslam {

struct SeenTrack {
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();           // [px]
  Eigen::Vector2f keyframe_pixel = Eigen::Vector2f::Zero();  // where it was in the latest keyframe [px]
  Eigen::Vector2f normal = Eigen::Vector2f::UnitX();         // of the edge, unit
  bool corner = false;
  bool mapped = false;   // has a point in the map
  bool outlier = false;  // its map point did not fit the pose
};

struct SeenEdgePoint {
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();  // [px]
  int chain = -1;                                   // points of one edge follow each other
};

struct FrameLook {
  std::int64_t index = 0;
  std::int64_t time_ns = 0;
  TrackingState state = TrackingState::initialising;
  std::shared_ptr<const FrameImages> images;  // null before the first frame
  std::vector<SeenTrack> tracks;              // none where the frame was not tracked
  std::vector<SeenEdgePoint> edges;           // thinned where there are more than most_seen_edge_points
};

constexpr std::size_t most_seen_tracks = 4096;
constexpr std::size_t most_seen_edge_points = 16384;

// Between tracking's thread and one that looks on. Must outlive the runs that fill it.
class FrameLooks {
 public:
  FrameLooks();

  // The looking thread's: the next frame is looked at, then no more until the next asking.
  void ask() { asked_.store(true, std::memory_order_release); }
  // True where there is a newer look, which is then the caller's until the next call.
  bool take() { return looks_.take(); }
  const FrameLook& look() { return looks_.reading(); }
  // Lets the images go that the caller's look keeps.
  void letGo() { looks_.reading().images.reset(); }

  // Tracking's, after each frame that could be read; without allocation, lock or system call.
  void show(const FrameResult& result, const Tracker& tracker) {
    if (!asked_.load(std::memory_order_relaxed)) return;
    asked_.store(false, std::memory_order_relaxed);
    fill(result, tracker, looks_.writing());
    looks_.publish();
  }

 private:
  static void fill(const FrameResult& result, const Tracker& tracker, FrameLook& look);

  std::atomic<bool> asked_{false};
  TripleBuffer<FrameLook> looks_;
};

}  // namespace edgeslam
