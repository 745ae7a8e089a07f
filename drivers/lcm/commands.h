// Commands from the robot, checked; and their answers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "edgeslam/command_answer_t.hpp"
#include "edgeslam/command_t.hpp"

namespace edgeslam {

enum class CommandKind { reset, save_map, start_recording, stop_recording, set_scale, send_map };

enum class CommandSender { robot, viewer };

struct Command {
  std::int64_t id = 0;  // the sender's
  CommandKind kind = CommandKind::reset;
  // Of set_scale: between the frames of these time stamps the camera moved so far.
  std::int64_t from_utime = 0;
  std::int64_t to_utime = 0;
  double distance_m = 0;
  CommandSender sender = CommandSender::robot;  // who gets the answer
};

struct CheckedCommand {
  std::optional<Command> command;           // where it can be done
  std::optional<command_answer_t> refusal;  // of a command_t that makes no sense: why
};

CheckedCommand checkCommand(const command_t& message, std::int64_t utime);

// Neither of the two: the bytes are no command_t (of another type, too short, too long).
CheckedCommand checkCommand(const void* data, std::size_t bytes, std::int64_t utime);

command_answer_t commandAnswer(const Command& command, bool accepted, const std::string& message, std::int64_t utime);

}  // namespace edgeslam
