#include "drivers/viewer/viewer.h"

#include <signal.h>

#include <thread>
#include <utility>

#include "drivers/viewer/view_server.h"
#include "pipeline/thread_setup.h"

namespace edgeslam {
namespace {

constexpr int niceness = 10;

std::string addressOf(const ViewerOptions& options, int port) {
  const bool six = options.address.find(':') != std::string::npos;
  return "http://" + (six ? "[" + options.address + "]" : options.address) + ":" + std::to_string(port) + "/";
}

}  // namespace

bool viewerIsBuiltIn() { return true; }

struct Viewer::Work {
  Work(const ViewerOptions& options, const ViewerSetup& setup, const ViewerPatience& patience)
      : server(options, setup, patience, feed), address(addressOf(options, server.port())) {
    // The program's signals are for those who wait for them.
    sigset_t all{}, before{};
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &before);
    thread = std::thread([this] {
      setUpThread({"viewer", 0, niceness, false, {}});
      server.run();
    });
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
  }
  ~Work() {
    server.stop();
    thread.join();
  }

  void show() {
    feed.states.writing() = state;
    feed.states.publish();
  }

  ViewFeed feed;
  ViewServer server;
  std::string address;
  ViewedState state;
  std::thread thread;
};

Viewer::Viewer(const ViewerOptions& options, const ViewerSetup& setup, const ViewerPatience& patience)
    : work_(std::make_unique<Work>(options, setup, patience)) {}
Viewer::~Viewer() = default;

const std::string& Viewer::address() const { return work_->address; }
bool Viewer::isWatched() const { return work_->feed.is_watched.load(std::memory_order_acquire); }
FrameLooks& Viewer::looks() { return work_->feed.looks; }

void Viewer::frame(const FrameResult& result) {
  if (!isWatched()) return;
  work_->feed.samples.push({result.time_ns / 1000, result.state, result.latency_ms, result.times.total()});
  work_->state.frame = result;
  work_->state.has_frame = true;
  work_->show();
}

void Viewer::status(const PublisherStatus& status, const ScaleState& scale, const std::string& lcm_problem) {
  work_->state.status = status;
  work_->state.scale = scale;
  work_->state.lcm_problem = lcm_problem;
  work_->show();
}

void Viewer::map(std::shared_ptr<const Map> map, int world) {
  work_->feed.maps.writing() = {std::move(map), world};
  work_->feed.maps.publish();
}

void Viewer::note(const std::string& text) {
  work_->state.note = text;
  work_->show();
}

std::optional<Command> Viewer::nextCommand() {
  Command* received = work_->feed.commands.receive();
  if (!received) return std::nullopt;
  const Command command = *received;
  work_->feed.commands.release(received);
  return command;
}

void Viewer::answer(const Command& command, bool accepted, const std::string& message) {
  ViewedAnswer* sent = work_->feed.answers.claim();
  if (!sent) return;  // so many that nobody waits for the oldest any more
  *sent = {command.id, accepted, message};
  work_->feed.answers.send(sent);
}

}  // namespace edgeslam
