#include "drivers/lcm/command_receiver.h"

#include <utility>

#include "drivers/lcm/clocks.h"

namespace edgeslam {

CommandReceiver::CommandReceiver(std::string url, std::string channel)
    : listener_(std::move(url), std::move(channel), "commands",
                [this](const void* data, std::size_t bytes) { take(data, bytes); }) {}

std::optional<CheckedCommand> CommandReceiver::next() {
  CheckedCommand command;
  if (!waiting_.pop(command)) return std::nullopt;
  return command;
}

void CommandReceiver::take(const void* data, std::size_t bytes) {
  const CheckedCommand command = checkCommand(data, bytes, monotonicUtime());
  const bool none = !command.command && !command.refusal;
  if (none || !waiting_.push(command)) ignored_.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace edgeslam
