// Messages on the command channel: a command within its limits, a refusal with one line of reason, or nothing.
#include <cmath>

#include "drivers/lcm/commands.h"
#include "fuzz_input.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edgeslam;
  const CheckedCommand checked = checkCommand(data, size, 7);
  require(!(checked.command && checked.refusal), "a message is not both done and refused");
  if (checked.refusal) {
    requireMessage(checked.refusal->message, "");
    require(!checked.refusal->accepted && checked.refusal->utime == 7, "a refusal is one");
  }
  if (checked.refusal || checked.command) {
    command_t message;
    const int length = message.decode(data, 0, static_cast<int>(size));
    require(length == static_cast<int>(size), "no byte is left over");
    std::vector<std::uint8_t> again(size);
    require(message.encode(again.data(), 0, length) == length, "a command can be sent again");
    require(std::equal(again.begin(), again.end(), data), "a command that is sent again is the same");
  }
  if (!checked.command) return 0;
  const Command& command = *checked.command;
  if (command.kind == CommandKind::set_scale) {
    require(command.distance_m > 0 && command.distance_m <= 1e5, "distances are possible ones");
    require(command.from_utime < command.to_utime, "the way goes forward in time");
  }
  const command_answer_t answer = commandAnswer(command, true, std::string(data, data + size), 8);
  require(answer.id == command.id, "an answer names its command");
  require(answer.accepted && answer.message.size() <= 200, "an answer's text is bounded");
  if (!answer.message.empty()) requireMessage(answer.message, "");
  return 0;
}
