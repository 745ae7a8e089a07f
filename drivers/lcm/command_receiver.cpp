#include "drivers/lcm/command_receiver.h"

#include <pthread.h>

#include "drivers/lcm/clocks.h"

namespace edgeslam {
namespace {

constexpr int patience_ms = 100;  // how long a stop may go unnoticed

}  // namespace

CommandReceiver::CommandReceiver(std::string url, std::string channel)
    : url_(std::move(url)), channel_(std::move(channel)), thread_([this] { listen(); }) {}

CommandReceiver::~CommandReceiver() {
  stopping_.store(true, std::memory_order_release);
  thread_.join();
}

std::optional<CheckedCommand> CommandReceiver::next() {
  CheckedCommand command;
  if (!waiting_.pop(command)) return std::nullopt;
  return command;
}

void CommandReceiver::listen() {
  pthread_setname_np(pthread_self(), "commands");
  LcmHandle lcm;
  BackOff back_off;
  while (!stopping_.load(std::memory_order_acquire)) {
    if (join_anew_.exchange(false)) lcm.reset();
    if (!lcm && back_off.due(BackOff::Clock::now())) {
      lcm = open();
      back_off.failed(BackOff::Clock::now());
    }
    listening_.store(lcm != nullptr, std::memory_order_release);
    if (!lcm) {
      std::this_thread::sleep_for(std::chrono::milliseconds(patience_ms));
    } else if (lcm_handle_timeout(lcm.get(), patience_ms) < 0) {
      lcm.reset();
    } else {
      back_off.reset();
    }
  }
  listening_.store(false, std::memory_order_release);
}

LcmHandle CommandReceiver::open() {
  std::string problem;
  LcmHandle lcm = openLcm(url_, problem);
  if (lcm && !lcm_subscribe(lcm.get(), channel_.c_str(), &CommandReceiver::received, this)) lcm.reset();
  return lcm;
}

void CommandReceiver::received(const lcm_recv_buf_t* buffer, const char*, void* receiver) {
  static_cast<CommandReceiver*>(receiver)->take(*buffer);
}

void CommandReceiver::take(const lcm_recv_buf_t& buffer) {
  const CheckedCommand command = checkCommand(buffer.data, buffer.data_size, monotonicUtime());
  const bool none = !command.command && !command.refusal;
  if (none || !waiting_.push(command)) ignored_.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace edgeslam
