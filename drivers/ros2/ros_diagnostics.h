// How the program is doing, for ROS 2's tools (diagnostic_msgs/DiagnosticArray): the same as SLAM_STATUS has.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "edgeslam/status_t.hpp"
#include "scale/scale_state.h"

namespace edgeslam {

enum class RosLevel : std::uint8_t { ok = 0, warning = 1, error = 2 };

struct RosDiagnosis {
  RosLevel level = RosLevel::ok;
  std::string name, message;
  std::vector<std::pair<std::string, std::string>> values;
};

struct RosDiagnostics {
  std::int64_t stamp_ns = 0;
  std::vector<RosDiagnosis> parts;
};

// One part on the pose, with the figures, and one on the scale. `node`: before their names.
RosDiagnostics rosDiagnostics(const status_t& status, const ScaleState& scale, const std::string& node,
                              std::int64_t stamp_ns);

}  // namespace edgeslam
