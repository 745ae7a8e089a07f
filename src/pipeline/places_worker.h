// Places at work: each snapshot of the map is looked at for loops (P23 to P27) and adjusted as a whole where that is
// due (P20). Gives corrections; the map itself is mapping's.
#pragma once

#include <atomic>

#include "mapping/global_adjustment.h"
#include "pipeline/messages.h"
#include "pipeline/settings.h"
#include "places/loop_closing.h"

namespace edgeslam {

class PlacesWorker {
 public:
  PlacesWorker(const Camera& camera, const Settings& settings)
      : calibrated_(camera),
        camera_(camera),
        settings_(settings),
        loop_closing_(camera, {settings.edges, settings.points.accuracy}, settings.loops) {}

  // Snapshots in the order of their numbers, not necessarily all.
  Correction work(const Snapshot& snapshot);

  // From any thread: the adjustment of the whole map that is under way is given up, and none is begun.
  void interrupt(bool interrupted) { interrupted_.store(interrupted, std::memory_order_relaxed); }

 private:
  enum class Meeting { none, first, longer };

  Correction correctionOf(const Snapshot& snapshot);
  bool closeLoop(Map& map, Correction& correction);
  Meeting meetOldPart(const Map& map);
  bool globalAdjustmentDue(const Map& map) const;

  Camera calibrated_;
  Camera camera_;  // with what was found of it
  Settings settings_;
  LoopClosing loop_closing_;
  std::atomic<bool> interrupted_{false};
  std::int64_t origin_frame_ = -1;   // of the map's first keyframe
  KeyframeId last_met_ = -1;         // latest keyframe that met an old part of the map ...
  KeyframeId last_shared_out_ = -1;  // ... and the latest at which the drift was shared out for it
  KeyframeId last_global_ = 0;       // latest keyframe at the last global adjustment ...
  std::int64_t last_global_ns_ = 0;  // ... and its time
};

}  // namespace edgeslam
