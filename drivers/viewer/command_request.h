// A command from the page: JSON in, the same checks as of one over LCM, JSON out.
//
//     {"command": "set_scale", "from_utime": 1000000, "to_utime": 2000000, "distance_m": 0.5}
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "drivers/lcm/commands.h"

namespace edgeslam {

struct CommandRequest {
  std::optional<Command> command;  // where it can be done
  std::string problem;             // why it cannot; empty otherwise
};

// `id`: the command's number. Commands: reset, save_map, start_recording, stop_recording, set_scale, send_map; the
// members but `command` are of set_scale alone.
CommandRequest readCommandRequest(std::string_view body, std::int64_t id);

// {"accepted": true, "message": "..."}
std::string commandAnswerText(bool accepted, const std::string& message);

}  // namespace edgeslam
