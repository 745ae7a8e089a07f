#include "drivers/viewer/command_request.h"

#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "drivers/lcm/clocks.h"
#include "edgeslam/input_error.h"

namespace edgeslam {
namespace {

using Json = nlohmann::json;

constexpr std::array<std::pair<const char*, std::int8_t>, 6> kinds{{{"reset", command_t::RESET},
                                                                    {"save_map", command_t::SAVE_MAP},
                                                                    {"start_recording", command_t::START_RECORDING},
                                                                    {"stop_recording", command_t::STOP_RECORDING},
                                                                    {"set_scale", command_t::SET_SCALE},
                                                                    {"send_map", command_t::SEND_MAP}}};

std::optional<std::int8_t> kindOf(const Json& name) {
  for (const auto& [known, number] : kinds) {
    if (name == known) return number;
  }
  return std::nullopt;
}

// Empty, or what is wrong.
std::string readScaleMember(const std::string& name, const Json& value, command_t& message) {
  if (name == "distance_m") {
    if (!value.is_number()) return "distance_m must be a number";
    message.distance_m = value.get<double>();
    return "";
  }
  if (name != "from_utime" && name != "to_utime") return "'" + name.substr(0, 40) + "' is not expected here";
  // 2^63 and more would wrap around.
  if (!value.is_number_integer() || (value.is_number_unsigned() && value.get<std::uint64_t>() > INT64_MAX)) {
    return name + " must be a whole number of microseconds";
  }
  (name == "from_utime" ? message.from_utime : message.to_utime) = value.get<std::int64_t>();
  return "";
}

}  // namespace

CommandRequest readCommandRequest(std::string_view body, std::int64_t id) {
  const Json request = Json::parse(body.begin(), body.end(), nullptr, /*allow_exceptions=*/false);
  if (!request.is_object()) return {std::nullopt, "a JSON object is expected"};
  const auto name = request.find("command");
  const std::optional<std::int8_t> kind = name == request.end() ? std::nullopt : kindOf(*name);
  if (!kind) {
    return {std::nullopt, "command must be reset, save_map, start_recording, stop_recording, set_scale or send_map"};
  }
  command_t message{};
  message.id = id;
  message.command = *kind;
  for (const auto& [member, value] : request.items()) {
    if (member == "command") continue;
    const std::string wrong = *kind == command_t::SET_SCALE ? readScaleMember(member, value, message)
                                                            : "'" + member.substr(0, 40) + "' is not expected here";
    if (!wrong.empty()) return {std::nullopt, InputError::oneLine(wrong)};
  }
  CheckedCommand checked = checkCommand(message, monotonicUtime());
  if (checked.refusal) return {std::nullopt, checked.refusal->message};
  checked.command->sender = CommandSender::viewer;
  return {checked.command, ""};
}

std::string commandAnswerText(bool accepted, const std::string& message) {
  return Json{{"accepted", accepted}, {"message", message}}.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace edgeslam
