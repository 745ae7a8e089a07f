// The daemon's camera is taken away and comes back, in a virtual machine: feeder and driver.
#include "system/program.h"
#include "vm/loopback_daemon.h"
#include "vm/vivid_device.h"

namespace edgeslam {
namespace {

constexpr std::int64_t ms = 1'000'000;

class LoopbackReturn : public LoopbackDaemon {
 protected:
  void SetUp() override {
    LoopbackDaemon::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    if (environment("EDGESLAM_SEQUENCE").empty()) GTEST_SKIP() << "no sequence is named by EDGESLAM_SEQUENCE";
    sequence_ = readFedSequence(environment("EDGESLAM_SEQUENCE"), 10, 120);
  }

  // Where it comes back the picture begins at the start: it is not just tracked on.
  static bool isFarFromTheStart(const LoopbackFeeder& feeder) {
    const std::int64_t index = fedIndex(FeedingOrder::there_and_back, feeder.position(), 120);
    return index > 100;
  }
  // Ends the feeder, and returns how long the daemon takes to say so [ns], from when the next frame was due.
  std::int64_t timeToTell(std::unique_ptr<LoopbackFeeder>& feeder, const BackgroundProcess& daemon) const {
    const int before = daemon.times("frozen") + daemon.times("broke");
    feeder.reset();
    const std::int64_t gone_ns = now_ns();
    EXPECT_TRUE(comesTrue([&] { return daemon.times("frozen") + daemon.times("broke") > before; })) << daemon.said();
    return now_ns() - gone_ns;
  }
  bool statusTells(const std::string& reason) const {
    const std::size_t before = robot_->heard().statuses.size();
    return hears([&](const Heard& heard) {
      for (std::size_t i = before; i < heard.statuses.size(); ++i) {
        const status_t& status = heard.statuses[i];
        if (status.state == state_t::LOST && status.reason.find(reason) != std::string::npos) return true;
      }
      return false;
    });
  }
  // Found again in the map, at the first measured pose after the n-th state.
  bool isFoundAgainAfter(std::size_t before, state_t& found) const {
    return hears([&](const Heard& heard) {
      for (std::size_t i = before; i < heard.states.size(); ++i) {
        if (!isMeasured(heard.states[i])) continue;
        found = heard.states[i];
        return true;
      }
      return false;
    });
  }

  FedSequence sequence_;
};

TEST_F(LoopbackReturn, AFeederThatComesBackIsFoundInTheSameMap) {
  auto feeder = feed(sequence_, FeedingOrder::there_and_back);
  const auto daemon = start(sequence_);
  ASSERT_TRUE(tracks()) << daemon->said();
  ASSERT_TRUE(comesTrue([&] { return isFarFromTheStart(*feeder); }, patience_s));
  const int keyframes = robot_->heard().statuses.back().keyframes;

  const std::int64_t told_ns = timeToTell(feeder, *daemon);
  std::cout << "feeder gone: told after " << told_ns / ms << " ms\n";
  EXPECT_LT(told_ns, 500 * ms);
  EXPECT_TRUE(statusTells("")) << daemon->said();
  std::cout << "status: " << robot_->heard().statuses.back().reason << "\n";

  const std::size_t before = robot_->heard().states.size();
  feeder = feed(sequence_, FeedingOrder::there_and_back);
  state_t found{};
  ASSERT_TRUE(isFoundAgainAfter(before, found)) << daemon->said();
  std::cout << "found again as " << static_cast<int>(found.state) << "\n" << daemon->said();
  EXPECT_EQ(found.state, state_t::RELOCALISED);
  EXPECT_GE(robot_->heard().statuses.back().keyframes, keyframes) << "the map was kept";
  daemon->send(SIGTERM);
  EXPECT_EQ(daemon->exitCode(), 0) << daemon->said();
}

TEST_F(LoopbackReturn, ADriverThatIsUnloadedAndLoadedAgain) {
  const std::string module = environment("EDGESLAM_LOOPBACK_MODULE");
  if (module.empty()) GTEST_SKIP() << "no module is named by EDGESLAM_LOOPBACK_MODULE";
  auto feeder = feed(sequence_, FeedingOrder::there_and_back);
  const auto daemon = start(sequence_);
  ASSERT_TRUE(tracks()) << daemon->said();
  ASSERT_TRUE(comesTrue([&] { return isFarFromTheStart(*feeder); }, patience_s));
  feeder.reset();
  // It is in use while the daemon tries to open it: between two tries.
  Outcome unloaded;
  ASSERT_TRUE(comesTrue(
      [&] {
        return (unloaded = runCommand({"rmmod", "v4l2loopback"})).exit_code == 0;
      },
      patience_s))
      << unloaded.messages << daemon->said();
  EXPECT_TRUE(statusTells("not plugged in")) << daemon->said();
  std::this_thread::sleep_for(std::chrono::seconds(5));

  const std::size_t before = robot_->heard().states.size();
  ASSERT_TRUE(runsWell("insmod " + module + " video_nr=42 exclusive_caps=0 card_label=Loopback"));
  feeder = feed(sequence_, FeedingOrder::there_and_back);
  state_t found{};
  ASSERT_TRUE(isFoundAgainAfter(before, found)) << daemon->said();
  std::cout << daemon->said();
  EXPECT_EQ(found.state, state_t::RELOCALISED);
  daemon->send(SIGTERM);
  EXPECT_EQ(daemon->exitCode(), 0) << daemon->said();
}

}  // namespace
}  // namespace edgeslam
