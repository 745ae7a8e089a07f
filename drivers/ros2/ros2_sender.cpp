#include "drivers/ros2/ros2_sender.h"

#include <time.h>

#include <cerrno>
#include <utility>

#include "drivers/ros2/ros_names.h"
#include "pipeline/thread_setup.h"

namespace edgeslam {
namespace {

using Clock = BackOff::Clock;

constexpr std::size_t most_waiting = 256;               // [messages]
constexpr std::chrono::milliseconds longest_wait(500);  // older messages are of no use to a controller
constexpr std::chrono::milliseconds time_at_the_end(200);
constexpr std::chrono::seconds between_looks(1);
constexpr std::chrono::milliseconds between_looks_for_odometry(5);
constexpr std::size_t most_not_heard_yet = 30;  // [frames]
constexpr std::size_t most_events = 16, most_told = 64;

}  // namespace

Ros2Sender::Ros2Sender(const Ros2Options& options, int real_time_priority)
    : options_(options), real_time_priority_(real_time_priority), waiting_(most_waiting) {
  sem_init(&handed_over_, 0, 0);
  thread_ = std::thread([this] { run(); });
}

Ros2Sender::~Ros2Sender() {
  stopping_.store(true, std::memory_order_release);
  sem_post(&handed_over_);
  thread_.join();
  sem_destroy(&handed_over_);
}

void Ros2Sender::send(RosMessage message) {
  if (given_up_.load(std::memory_order_relaxed)) return;
  Waiting* slot = waiting_.claim();
  if (!slot) {
    overflowed_.store(true, std::memory_order_relaxed);
    return;
  }
  slot->message = std::move(message);
  slot->handed_over = Clock::now();
  waiting_.send(slot);
  sem_post(&handed_over_);
}

std::optional<std::string> Ros2Sender::nextEvent() {
  const std::lock_guard<std::mutex> lock(events_mutex_);
  if (events_.empty()) return std::nullopt;
  std::string event = std::move(events_.front());
  events_.pop_front();
  return event;
}

// A line that comes again says nothing new.
void Ros2Sender::tellOnce(const std::string& line) {
  if (told_.size() >= most_told || !told_.insert(line).second) return;
  const std::lock_guard<std::mutex> lock(events_mutex_);
  if (events_.size() < most_events) events_.push_back("ROS 2: " + InputError::oneLine(line));
}

// The thread.
void Ros2Sender::run() {
  setUpThread({"ros2", 0, 0, false, {}});
  Clock::time_point end = Clock::time_point::max();
  while (!given_up_.load(std::memory_order_relaxed) && Clock::now() < end) {
    const bool is_stopping = stopping_.load(std::memory_order_acquire);
    if (is_stopping) end = std::min(end, Clock::now() + time_at_the_end);
    if (!wire_) openWhenDue();
    lookRound();
    if (Waiting* waiting = waiting_.receive()) {
      deliver(*waiting);
      waiting_.release(waiting);
    } else if (is_stopping) {
      break;
    } else {
      wait();
    }
  }
  wire_.reset();
}

// For a message, or for when to look round.
void Ros2Sender::wait() {
  const std::chrono::milliseconds longest = not_heard_yet_.empty() ? between_looks : between_looks_for_odometry;
  timespec until{};
  clock_gettime(CLOCK_REALTIME, &until);
  constexpr long second_ns = 1000000000;
  const long ns = until.tv_nsec + static_cast<long>(std::chrono::nanoseconds(longest).count());
  until.tv_sec += ns / second_ns;
  until.tv_nsec = ns % second_ns;
  sem_timedwait(&handed_over_, &until);
}

void Ros2Sender::openWhenDue() {
  const Clock::time_point now = Clock::now();
  if (!back_off_.due(now)) return;
  back_off_.failed(now);
  RosWireSetup setup;
  try {
    setup.domain = effectiveDomain(options_);
  } catch (const InputError& error) {
    tellOnce(std::string("left out: ") + error.what());
    given_up_.store(true, std::memory_order_relaxed);
    return;
  }
  setup.topic_namespace = options_.topic_namespace;
  setup.hears_transforms = options_.transforms == "map_to_odom";
  OpenedRosWire opened = openRosWire(setup);
  wire_ = std::move(opened.wire);
  if (wire_) {
    // Only now: DDS's own threads have the priority of who begins them, and a flood that they read must delay nobody.
    // The start check has told what is not allowed.
    setUpThread({"ros2", real_time_priority_, 0, false, {}});
    tellOnce("messages go out on domain " + std::to_string(setup.domain) + ", odometry as " +
             rosTopic(options_.topic_namespace, "odom"));
  } else if (opened.may_come) {
    tellOnce("messages do not go out: " + opened.problem + "; tried anew");
  } else {
    tellOnce("left out: " + opened.problem);
    given_up_.store(true, std::memory_order_relaxed);
  }
}

// At what others send, and at what is wrong.
void Ros2Sender::lookRound() {
  if (!wire_) return;
  sendMapToOdom();
  const Clock::time_point now = Clock::now();
  if (now < next_look_) return;
  next_look_ = now + between_looks;
  for (const std::string& topic : wire_->rivals()) {
    tellOnce("another program publishes " + topic +
             " on this domain, too: give one of them another ros2.namespace or ros2.domain");
  }
  if (const std::string complaint = wire_->complaint(); !complaint.empty()) tellOnce("DDS says: " + complaint);
  if (overflowed_.exchange(false, std::memory_order_relaxed)) {
    tellOnce("messages are left out: DDS takes them more slowly than they come");
  }
}

void Ros2Sender::deliver(const Waiting& waiting) {
  if (!wire_ || Clock::now() - waiting.handed_over > longest_wait) return;
  if (const auto* frame = std::get_if<RosFrame>(&waiting.message)) {
    sendFrame(*frame);
  } else if (const auto* cloud = std::get_if<RosCloud>(&waiting.message)) {
    expect(wire_->send(*cloud), "map_points");
  } else {
    expect(wire_->send(std::get<RosDiagnostics>(waiting.message)), "diagnostics");
  }
}

void Ros2Sender::sendFrame(const RosFrame& frame) {
  if (options_.transforms == "all" && frame.odometry) {  // first: who gets the odometry can transform it
    expect(wire_->send(std::vector<RosTransform>{*frame.map_T_odom, *frame.odom_T_body}), "tf");
  }
  if (options_.transforms == "map_to_odom" && frame.map_T_body) {
    not_heard_yet_.push_back(*frame.map_T_body);
    if (not_heard_yet_.size() > most_not_heard_yet) not_heard_yet_.pop_front();
  }
  if (frame.odometry) expect(wire_->send(*frame.odometry), "odom");
  if (frame.pose) expect(wire_->send(*frame.pose), "pose");
}

// Of the latest frame at which the other node's odometry is known by now.
void Ros2Sender::sendMapToOdom() {
  if (options_.transforms != "map_to_odom") return;
  wire_->takeTransforms([this](const RosTransform& transform) {
    if (transform.parent == options_.odom_frame && transform.child == options_.body_frame) {
      heard_.add(transform.stamp_ns, transform.pose);
    }
  });
  for (std::size_t i = not_heard_yet_.size(); i-- > 0;) {
    const RosTransform& map_T_body = not_heard_yet_[i];
    const std::optional<Pose> odom_T_body = heard_.at(map_T_body.stamp_ns);
    if (!odom_T_body) continue;
    const RosTransform map_T_odom{map_T_body.stamp_ns, map_T_body.parent, options_.odom_frame,
                                  map_T_body.pose * odom_T_body->inverse()};
    expect(wire_->send(std::vector<RosTransform>{map_T_odom}), "tf");
    not_heard_yet_.erase(not_heard_yet_.begin(), not_heard_yet_.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    return;
  }
}

void Ros2Sender::expect(bool sent, const std::string& what) {
  if (!sent) tellOnce("messages of " + what + " are left out: a subscriber does not take in those before");
}

}  // namespace edgeslam
