#include "drivers/lcm/lcm_sender.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "drivers/lcm/lcm_options.h"
#include "pipeline/thread_setup.h"

namespace edgeslam {
namespace {

constexpr std::size_t most_waiting = 1024;              // [messages]
constexpr std::chrono::milliseconds longest_wait(500);  // older messages are of no use to a controller
constexpr std::chrono::milliseconds time_at_the_end(500);

}  // namespace

LcmHandle openLcm(const std::string& url, std::string& problem) {
  if (const std::optional<MulticastGroup> group = multicastGroup(url)) {
    problem = multicastRouteProblem(*group);
    if (!problem.empty()) return nullptr;
  }
  LcmHandle lcm(lcm_create(url.c_str()));
  if (!lcm) problem = "LCM: " + url + " cannot be opened";
  return lcm;
}

void BackOff::failed(Clock::time_point now) {
  next_ = now + wait_;
  wait_ = std::min<Clock::duration>(2 * wait_, std::chrono::seconds(5));
}

void BackOff::reset() { *this = BackOff(); }

LcmSender::LcmSender(std::string url, int real_time_priority)
    : url_(std::move(url)), real_time_priority_(real_time_priority), waiting_(most_waiting) {
  sem_init(&handed_over_, 0, 0);
  thread_ = std::thread([this] { run(); });
}

LcmSender::~LcmSender() {
  stopping_.store(true, std::memory_order_release);
  sem_post(&handed_over_);
  thread_.join();
  sem_destroy(&handed_over_);
}

// Null where the queue is full.
LcmSender::Packet* LcmSender::claim() {
  Packet* packet = waiting_.claim();
  if (!packet) leaveOut();
  return packet;
}

void LcmSender::leaveOut() {
  not_sent_.fetch_add(1, std::memory_order_relaxed);
  overflowed_.store(true, std::memory_order_relaxed);
}

void LcmSender::handOver(Packet* packet) {
  packet->handed_over = BackOff::Clock::now();
  waiting_.send(packet);
  sem_post(&handed_over_);
}

std::string LcmSender::problem() const {
  const std::lock_guard<std::mutex> lock(problem_mutex_);
  if (!problem_.empty() || !overflowed_.load(std::memory_order_relaxed)) return problem_;
  return "LCM: " + url_ + ": the network takes messages more slowly than they come";
}

void LcmSender::setProblem(const std::string& problem) {
  const std::lock_guard<std::mutex> lock(problem_mutex_);
  problem_ = problem;
}

// The thread.
void LcmSender::run() {
  setUpThread({"lcm", real_time_priority_, 0, false, {}});  // the start check has told what is not allowed
  BackOff::Clock::time_point end = BackOff::Clock::time_point::max();
  while (BackOff::Clock::now() < end) {
    if (stopping_.load(std::memory_order_acquire)) end = std::min(end, BackOff::Clock::now() + time_at_the_end);
    if (Packet* packet = waiting_.receive()) {
      deliver(*packet);
      waiting_.release(packet);
    } else if (stopping_.load(std::memory_order_acquire)) {
      break;
    } else {
      while (sem_wait(&handed_over_) != 0 && errno == EINTR) continue;
    }
  }
}

void LcmSender::deliver(const Packet& packet) {
  if (BackOff::Clock::now() - packet.handed_over > longest_wait) {
    leaveOut();
    return;
  }
  if (!publish(packet)) {
    not_sent_.fetch_add(1, std::memory_order_relaxed);
    failing_ = true;
    openWhenDue();
    return;
  }
  sent_.fetch_add(1, std::memory_order_relaxed);
  if (waiting_.waiting() == 0) overflowed_.store(false, std::memory_order_relaxed);
  if (!failing_) return;
  failing_ = false;
  back_off_.reset();
  setProblem("");
  comebacks_.fetch_add(1, std::memory_order_relaxed);
}

bool LcmSender::publish(const Packet& packet) {
  if (!lcm_) openWhenDue();
  if (!lcm_) return false;
  errno = 0;
  const auto bytes = static_cast<unsigned>(packet.bytes.size());
  if (lcm_publish(lcm_.get(), packet.channel.c_str(), packet.bytes.data(), bytes) == 0) return true;
  setProblem("LCM: " + url_ + ": messages cannot be sent (" + std::strerror(errno) + ")");
  return false;
}

// An open one that fails is kept until a new one can be opened: it may come back by itself.
void LcmSender::openWhenDue() {
  const BackOff::Clock::time_point now = BackOff::Clock::now();
  if (!back_off_.due(now)) return;
  back_off_.failed(now);
  std::string problem;
  LcmHandle opened = openLcm(url_, problem);
  if (opened) {
    lcm_ = std::move(opened);
  } else {
    setProblem(problem);
  }
}

}  // namespace edgeslam
