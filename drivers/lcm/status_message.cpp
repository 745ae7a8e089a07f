#include "drivers/lcm/status_message.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "drivers/lcm/messages.h"

namespace edgeslam {
namespace {

double finite(double value) { return std::isfinite(value) ? value : -1; }

std::int64_t residentMemory_bytes() {
  std::ifstream file("/proc/self/statm");
  std::int64_t total_pages = 0, resident_pages = 0;
  if (!(file >> total_pages >> resident_pages)) return -1;
  return resident_pages * sysconf(_SC_PAGESIZE);
}

double warmestZone_c(const std::string& sys) {
  double warmest_c = -1;
  std::error_code error;
  std::filesystem::directory_iterator zones(sys + "/class/thermal", error);
  for (; !error && zones != std::filesystem::directory_iterator(); zones.increment(error)) {
    if (zones->path().filename().string().rfind("thermal_zone", 0) != 0) continue;
    std::ifstream file(zones->path() / "temp");
    double thousandths_c = 0;
    if (file >> thousandths_c && thousandths_c < 200e3) warmest_c = std::max(warmest_c, thousandths_c / 1000);
  }
  return warmest_c;
}

}  // namespace

SystemFigures systemFigures(const std::string& sys) { return {residentMemory_bytes(), warmestZone_c(sys)}; }

status_t statusMessage(const PublisherStatus& status, const FrameFigures& frames, const LcmCounts& counts,
                       const SystemFigures& system, std::int64_t sequence, std::int64_t utime) {
  status_t message;
  message.utime = utime;
  message.sequence = sequence;
  message.uptime_ms = status.uptime_ms;
  const bool has_camera = status.camera_problem.empty();
  message.state = stateNumber(has_camera ? frames.state : TrackingState::lost);
  message.reason = messageText(has_camera ? frames.reason : status.camera_problem);
  message.scale_reason = messageText(status.scale_problem);
  message.version = messageText(status.version);
  message.frames_per_second = finite(frames.frames_per_second);
  message.poses_per_second = finite(frames.poses_per_second);
  message.latency_p50_ms = finite(frames.latency_p50_ms);
  message.latency_p99_ms = finite(frames.latency_p99_ms);
  message.frames_captured = status.frames_captured;
  message.frames_dropped = status.frames_dropped;
  message.frames_unreadable = status.frames_unreadable;
  message.results_not_published = status.results_not_published;
  message.messages_sent = counts.sent;
  message.messages_not_sent = counts.not_sent;
  message.commands_ignored = counts.commands_ignored;
  message.recoveries = status.recoveries;
  message.relocalisations = status.relocalisations;
  message.loops = status.loops;
  message.mapping_queue = status.mapping_queue;
  message.publishing_queue = status.publishing_queue;
  message.keyframes = status.keyframes;
  message.points = status.points;
  message.worlds = status.worlds;
  message.memory_bytes = system.memory_bytes;
  message.temperature_c = finite(system.temperature_c);
  message.recording = status.recording;
  return message;
}

}  // namespace edgeslam
