// What tracking, mapping and places hand to each other (design, section 4): values, numbered in the order in which they
// are made. Each of the three is a pure function of what it was handed, in that order.
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "map/map_change.h"
#include "map/map_view.h"
#include "mapping/culling.h"
#include "pipeline/run_result.h"
#include "tracking/frame_result.h"
#include "tracking/tracker.h"

namespace edgeslam {

// Tracking to mapping: a frame, or a frame whose pose was lost.
struct MappingMessage {
  std::int64_t number = 0;  // counted from 0
  TrackedFrame frame;
  // Of a lost frame:
  std::shared_ptr<const EdgeMap> edges;
  std::optional<Pose> last_good_pose;  // none before the first
  double seconds_since = 0;            // the last good pose
  bool recover = false;                // its tracks run through the last keyframes: P21 before P22
  KeyframeId latest_believed = std::numeric_limits<KeyframeId>::max();  // what was mapped after it is in doubt
  bool starting = false;     // a world is begun beside those in which it is looked for
  std::int64_t sent_ns = 0;  // steady clock; for statistics alone
};

// The messages of one frame; their memory is used again for those of the next.
class FrameMessages {
 public:
  // Another message, as it was left.
  MappingMessage& add() { return messages_.at(count_++); }
  void clear() { count_ = 0; }
  // All there can be, to give them their memory.
  std::array<MappingMessage, 2>& all() { return messages_; }
  MappingMessage* begin() { return messages_.data(); }
  MappingMessage* end() { return messages_.data() + count_; }
  static constexpr std::size_t most = 2;  // the frame itself, and that it is looked for

 private:
  std::array<MappingMessage, most> messages_;
  std::size_t count_ = 0;
};

// A lost frame was found again.
struct FoundFrame {
  std::int64_t frame_index = -1;
  TrackingState how = TrackingState::relocalised;  // or recovered
  Pose world_T_camera;
  Matrix6d covariance = Matrix6d::Zero();
  std::vector<FoundAgain> points;  // empty: the tracks that it had go on
};

// Mapping to tracking. A newer update takes the place of those before.
struct MapUpdate {
  std::int64_t number = -1;   // counted from 0
  std::int64_t answers = -1;  // the latest message that it knows of
  MapView view;
  std::optional<FoundFrame> found;
  std::string not_found;  // why a lost frame was not found; empty where none was looked for
};

// Mapping to places: the map as it was after a keyframe.
struct Snapshot {
  std::int64_t number = 0;  // of the keyframe's message
  std::int64_t frame_index = 0;
  std::shared_ptr<const Map> map;
  std::int64_t sent_ns = 0;  // steady clock; for statistics alone
};

// Places to mapping: what became of a snapshot.
struct Correction {
  std::int64_t number = 0;          // of the snapshot
  MapChange change;                 // empty: nothing is to be done
  std::vector<std::string> events;  // loops closed and refused, with their reasons
  std::optional<ClosedLoop> loop;
  FoundCamera found;  // that all of it was made with
};

// What mapping and places did, for those who look at the run.
struct MappingReport {
  struct Found {
    TrackingState how = TrackingState::relocalised;
    KeyframeId reference = -1;  // the keyframe that carries the frame's final pose
    Pose reference_T_camera;
    int world = 0;
  };
  std::int64_t frame_index = 0;
  std::optional<Found> found;  // the frame was lost, and then it was not
  std::vector<std::string> events;
  bool is_of_setup = false;  // the events say what is to be configured otherwise
  // Where it changed: why the map's own metres, by inertia or the wheels, are not known; empty: they are, or neither is
  // there.
  std::optional<std::string> lacking_for_metres;
  std::vector<CulledKeyframe> culled;
  std::optional<ClosedLoop> loop;
  std::optional<WorldJoin> join;
  std::shared_ptr<const Map> map;  // where it was asked for; null otherwise
};

}  // namespace edgeslam
