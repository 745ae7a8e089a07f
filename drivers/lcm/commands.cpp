#include "drivers/lcm/commands.h"

#include <cmath>

#include "drivers/lcm/messages.h"

namespace edgeslam {
namespace {

constexpr double longest_distance_m = 1e5;

std::optional<CommandKind> kindOf(std::int8_t number) {
  switch (number) {
    case command_t::RESET:
      return CommandKind::reset;
    case command_t::SAVE_MAP:
      return CommandKind::save_map;
    case command_t::START_RECORDING:
      return CommandKind::start_recording;
    case command_t::STOP_RECORDING:
      return CommandKind::stop_recording;
    case command_t::SET_SCALE:
      return CommandKind::set_scale;
    case command_t::SEND_MAP:
      return CommandKind::send_map;
    default:
      return std::nullopt;
  }
}

std::int8_t numberOf(CommandKind kind) {
  switch (kind) {
    case CommandKind::reset:
      return command_t::RESET;
    case CommandKind::save_map:
      return command_t::SAVE_MAP;
    case CommandKind::start_recording:
      return command_t::START_RECORDING;
    case CommandKind::stop_recording:
      return command_t::STOP_RECORDING;
    case CommandKind::set_scale:
      return command_t::SET_SCALE;
    case CommandKind::send_map:
      break;
  }
  return command_t::SEND_MAP;
}

// Empty where it can be done.
std::string problemOf(const command_t& message) {
  const std::optional<CommandKind> kind = kindOf(message.command);
  if (!kind) return "command " + std::to_string(message.command) + " is not known";
  if (*kind != CommandKind::set_scale) return "";
  if (!(message.distance_m > 0 && message.distance_m <= longest_distance_m)) {
    return "distance_m must be over 0 and at most 100000";
  }
  if (message.from_utime >= message.to_utime) return "from_utime must be before to_utime";
  return "";
}

}  // namespace

CheckedCommand checkCommand(const void* data, std::size_t bytes, std::int64_t utime) {
  command_t message;
  const int expected = message.getEncodedSize();
  if (bytes != static_cast<std::size_t>(expected) || message.decode(data, 0, expected) != expected) return {};
  return checkCommand(message, utime);
}

CheckedCommand checkCommand(const command_t& message, std::int64_t utime) {
  CheckedCommand checked;
  const std::string problem = problemOf(message);
  if (problem.empty()) {
    checked.command = Command{message.id,       *kindOf(message.command), message.from_utime,
                              message.to_utime, message.distance_m,       CommandSender::robot};
  } else {
    checked.refusal.emplace();
    checked.refusal->utime = utime;
    checked.refusal->id = message.id;
    checked.refusal->command = message.command;
    checked.refusal->accepted = false;
    checked.refusal->message = messageText(problem);
  }
  return checked;
}

command_answer_t commandAnswer(const Command& command, bool accepted, const std::string& message, std::int64_t utime) {
  command_answer_t answer;
  answer.utime = utime;
  answer.id = command.id;
  answer.command = numberOf(command.kind);
  answer.accepted = accepted;
  answer.message = messageText(message);
  return answer;
}

}  // namespace edgeslam
