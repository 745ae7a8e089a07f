#include "drivers/ros2/ros_diagnostics.h"

#include <array>
#include <sstream>

#include "edgeslam/state_t.hpp"

namespace edgeslam {
namespace {

struct StateMeaning {
  std::int8_t state;
  RosLevel level;
  const char* name;
};

constexpr std::array<StateMeaning, 6> meanings{{{state_t::INITIALISING, RosLevel::warning, "initialising"},
                                                {state_t::TRACKING, RosLevel::ok, "tracking"},
                                                {state_t::PREDICTED, RosLevel::warning, "predicted"},
                                                {state_t::RECOVERED, RosLevel::ok, "recovered"},
                                                {state_t::RELOCALISED, RosLevel::ok, "relocalised"},
                                                {state_t::LOST, RosLevel::error, "lost"}}};

StateMeaning meaningOf(std::int8_t state) {
  for (const StateMeaning& meaning : meanings) {
    if (meaning.state == state) return meaning;
  }
  return {state, RosLevel::error, "not known"};
}

// Six digits that count.
std::string numberText(double value) {
  std::ostringstream text;
  text.precision(6);
  text << value;
  return text.str();
}

RosDiagnosis poseDiagnosis(const status_t& status, const std::string& node) {
  const StateMeaning meaning = meaningOf(status.state);
  RosDiagnosis diagnosis{meaning.level, node + ": pose", meaning.name, {}};
  if (!status.reason.empty()) diagnosis.message += ": " + status.reason;
  const auto tell = [&](const char* name, double value) {
    if (value >= 0) diagnosis.values.emplace_back(name, numberText(value));
  };
  tell("frames per second", status.frames_per_second);
  tell("poses per second", status.poses_per_second);
  tell("latency p50 [ms]", status.latency_p50_ms);
  tell("latency p99 [ms]", status.latency_p99_ms);
  tell("frames captured", static_cast<double>(status.frames_captured));
  tell("frames dropped", static_cast<double>(status.frames_dropped));
  tell("frames unreadable", static_cast<double>(status.frames_unreadable));
  tell("recoveries", status.recoveries);
  tell("relocalisations", status.relocalisations);
  tell("loops", status.loops);
  tell("keyframes", status.keyframes);
  tell("points", status.points);
  tell("worlds", status.worlds);
  tell("memory [MB]", status.memory_bytes < 0 ? -1 : 1e-6 * static_cast<double>(status.memory_bytes));
  tell("temperature [C]", status.temperature_c);
  diagnosis.values.emplace_back("recording", status.recording ? "yes" : "no");
  diagnosis.values.emplace_back("version", status.version);
  return diagnosis;
}

RosDiagnosis scaleDiagnosis(const status_t& status, const ScaleState& scale, const std::string& node) {
  const bool is_known = scale.kind != ScaleKind::unknown;
  RosDiagnosis diagnosis{is_known ? RosLevel::ok : RosLevel::warning,
                         node + ": scale",
                         is_known ? "lengths are in metres" : "not known: lengths are in map units",
                         {}};
  if (!status.scale_reason.empty()) diagnosis.message += ", " + status.scale_reason;
  if (!is_known) return diagnosis;
  diagnosis.values.emplace_back("metres per map unit", numberText(scale.metres_per_unit));
  diagnosis.values.emplace_back("standard deviation [%]", numberText(100 * scale.sigma));
  return diagnosis;
}

}  // namespace

RosDiagnostics rosDiagnostics(const status_t& status, const ScaleState& scale, const std::string& node,
                              std::int64_t stamp_ns) {
  return {stamp_ns, {poseDiagnosis(status, node), scaleDiagnosis(status, scale, node)}};
}

}  // namespace edgeslam
