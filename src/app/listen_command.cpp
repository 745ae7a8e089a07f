#include "app/listen_command.h"

#include <CLI/CLI.hpp>
#include <chrono>
#include <iostream>
#include <memory>

#include "app/listen_text.h"
#include "drivers/lcm/lcm_options.h"
#include "drivers/lcm/lcm_sender.h"
#include "drivers/lcm/messages.h"

namespace edgeslam {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int queue_capacity = 2000;  // [messages]
constexpr int longest_wait_ms = 100;

struct Listener {
  std::int64_t count = 0;  // still to print; counted down
  bool ends = false;
  GapWatch gaps;
  RateWatch rates;
};

void print(const lcm_recv_buf_t* buffer, const char* channel, void* user) {
  Listener& listener = *static_cast<Listener*>(user);
  if (listener.ends && listener.count <= 0) return;
  const std::string name = messageText(channel);
  const std::string gap = listener.gaps.add(name, buffer->data, buffer->data_size);
  if (!gap.empty()) std::cout << name << ": " << gap << "\n";
  std::cout << name << " " << describeMessage(buffer->data, buffer->data_size) << std::endl;
  listener.rates.add(name);
  --listener.count;
}

LcmHandle openForListening(const ListenArguments& arguments, const std::string& url, Listener& listener) {
  std::string problem;
  LcmHandle lcm = openLcm(url, problem);
  if (!lcm) throw InputError(problem);
  const std::vector<std::string> all{"SLAM_.*"};
  for (const std::string& channel : arguments.channels.empty() ? all : arguments.channels) {
    lcm_subscription_t* subscription = lcm_subscribe(lcm.get(), channel.c_str(), print, &listener);
    if (!subscription) throw InputError("channel '" + channel + "' cannot be listened to");
    lcm_subscription_set_queue_capacity(subscription, queue_capacity);
  }
  return lcm;
}

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

}  // namespace

int runListen(const ListenArguments& arguments) {
  LcmOptions options;
  options.url = arguments.url;
  const std::string url = effectiveUrl(options);
  Listener listener;
  listener.count = arguments.count;
  listener.ends = arguments.count > 0;
  const LcmHandle lcm = openForListening(arguments, url, listener);
  std::cerr << "listening to " << url << std::endl;

  Clock::time_point second = Clock::now();
  while (std::cout && !(listener.ends && listener.count <= 0)) {
    if (lcm_handle_timeout(lcm.get(), longest_wait_ms) < 0) throw InputError("LCM: " + url + " ended");
    if (const double seconds = since(second); seconds >= 1) {
      std::cout << "-- " << listener.rates.take(seconds) << "; lost " << listener.gaps.lost() << std::endl;
      second = Clock::now();
    }
  }
  return 0;
}

void addListenCommand(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("listen", "What is published over LCM, a line for each message");
  const auto arguments = std::make_shared<ListenArguments>();
  command->add_option("--url", arguments->url, "LCM's URL (default: LCM_DEFAULT_URL, or udpm://239.255.76.67:7667)");
  command->add_option("--channel", arguments->channels, "Name or pattern of the channels (default: SLAM_.*)");
  command->add_option("--count", arguments->count, "End after so many messages")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 40).description(""));
  command->callback([arguments, &exit_code] { exit_code = runListen(*arguments); });
}

}  // namespace edgeslam
