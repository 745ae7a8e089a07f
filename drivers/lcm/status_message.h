// How the program is doing, as a message: from what the run counts, and from what the publisher and the system know.
#pragma once

#include <cstdint>
#include <string>

#include "drivers/lcm/frame_statistics.h"
#include "edgeslam/status_t.hpp"

namespace edgeslam {

// What the run tells; -1 where a number is not known.
struct PublisherStatus {
  std::int64_t uptime_ms = -1;
  std::string version;
  std::int64_t frames_captured = -1;
  std::int64_t frames_dropped = -1;
  std::int64_t frames_unreadable = -1;
  std::int64_t results_not_published = -1;
  int recoveries = -1;
  int relocalisations = -1;
  int loops = -1;
  int mapping_queue = -1;
  int publishing_queue = -1;
  int keyframes = -1;
  int points = -1;
  int worlds = -1;
  bool recording = false;
  std::string camera_problem;  // why no frames come: the state is then lost, and this its reason; or empty
  std::string scale_problem;   // why the scale is not known, or not renewed; or empty
};

// What became of messages, since the start.
struct LcmCounts {
  std::int64_t sent = 0;
  std::int64_t not_sent = 0;
  std::int64_t commands = 0;          // taken in
  std::int64_t commands_ignored = 0;  // malformed, of a wrong type, or too many at once
};

struct SystemFigures {
  std::int64_t memory_bytes = -1;  // resident
  double temperature_c = -1;       // of the warmest thermal zone
};

// As of now; -1 where the system does not tell. `sys` is where sysfs is mounted.
SystemFigures systemFigures(const std::string& sys = "/sys");

status_t statusMessage(const PublisherStatus& status, const FrameFigures& frames, const LcmCounts& counts,
                       const SystemFigures& system, std::int64_t sequence, std::int64_t utime);

}  // namespace edgeslam
