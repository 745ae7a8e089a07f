// Poses over real UDP multicast, to programs of their own.
#include <gtest/gtest.h>

#include <lcm/lcm-cpp.hpp>

#include "drivers/lcm/lcm_publisher.h"
#include "drivers/lcm/messages.h"
#include "drivers/lcm/start_check.h"
#include "system/lcm/background_process.h"
#include "system/lcm/own_network.h"
#include "unit/lcm/made_frames.h"

namespace edgeslam {
namespace {

void pause(int microseconds) { std::this_thread::sleep_for(std::chrono::microseconds(microseconds)); }

void publishFrames(LcmPublisher& publisher, int count, int first = 0) {
  for (int i = first; i < first + count; ++i) {
    publisher.frame(measuredFrame(i, {Eigen::Quaterniond::Identity(), {0.01 * i, 0, 0}}));
    pause(500);
  }
}

// In small batches, each only after the last one was heard: nothing is lost on a loaded machine, either.
void publishHeard(LcmPublisher& publisher, int count, const std::function<bool(int)>& heard) {
  constexpr int batch = 20;
  for (int sent = 0; sent < count; sent += batch) {
    publishFrames(publisher, batch, sent);
    ASSERT_TRUE(comesTrue([&] { return heard(sent + batch); })) << sent;
  }
}

command_t resetCommand(std::int64_t id) {
  command_t command{};
  command.id = id;
  command.command = command_t::RESET;
  return command;
}

template <class Message>
void send(lcm::LCM& lcm, const std::string& channel, const Message& message) {
  ASSERT_EQ(lcm.publish(channel, &message), 0);
}

class LcmNetwork : public OwnNetwork {};

TEST_F(LcmNetwork, ASubscriberHearsEveryPose) {
  BackgroundProcess listener({EDGESLAM_PROGRAM, "listen", "--channel", "SLAM_STATE", "--count", "500"});
  ASSERT_TRUE(listener.says("listening to"));
  LcmPublisher publisher({}, Pose());
  publishHeard(publisher, 500, [&](int sent) { return listener.times("SLAM_STATE #") == sent; });
  EXPECT_EQ(listener.exitCode(), 0) << listener.said();
  EXPECT_EQ(listener.times("lost before this"), 0);
  EXPECT_NE(listener.said().find("#499 t 21.633"), std::string::npos) << "with its own time";
}

TEST_F(LcmNetwork, AListenerTellsWhatItMissed) {
  BackgroundProcess listener({EDGESLAM_PROGRAM, "listen", "--count", "2"});
  ASSERT_TRUE(listener.says("listening to"));
  lcm::LCM sender;
  state_t state = frameMessages(measuredFrame(0, Pose()), {}, std::nullopt, 10, 0).state;
  send(sender, "SLAM_STATE", state);
  state.sequence = 15;
  send(sender, "SLAM_STATE", state);
  EXPECT_EQ(listener.exitCode(), 0);
  EXPECT_EQ(listener.times("SLAM_STATE: 4 lost before this\n"), 1) << listener.said();
}

TEST_F(LcmNetwork, ARecordingOfTheLoggerPlaysBack) {
  const TemporaryFolder folder;
  const std::string log = folder.path("log");
  {
    BackgroundProcess logger({"lcm-logger", "--quiet", "--flush-interval=10", log});
    LcmPublisher publisher({}, Pose());
    // The logger does not say when it is ready: it is, when its file grows.
    int sent = 0;
    ASSERT_TRUE(comesTrue([&] {
      publishFrames(publisher, 1, sent++);
      return fileContent(log).size() > 1000;
    }));
    const std::size_t before = fileContent(log).size();
    constexpr std::size_t least_bytes_a_frame = 1000;
    publishHeard(publisher, 230, [&](int heard) {
      const bool is_logged =
          fileContent(log).size() > before + static_cast<std::size_t>(heard - 5) * least_bytes_a_frame;
      if (!is_logged) publishFrames(publisher, 1, sent++);  // in place of one that was lost on the way
      return is_logged;
    });
    logger.end(SIGINT);
  }
  BackgroundProcess listener({EDGESLAM_PROGRAM, "listen", "--channel", "SLAM_STATE", "--count", "200"});
  ASSERT_TRUE(listener.says("listening to"));
  BackgroundProcess player({"lcm-logplayer", "--speed=2", log});
  EXPECT_EQ(listener.exitCode(), 0) << listener.said();
  EXPECT_EQ(listener.times("malformed"), 0);
}

TEST_F(LcmNetwork, CommandsAreHeardAndAnswered) {
  BackgroundProcess listener({EDGESLAM_PROGRAM, "listen", "--channel", "SLAM_ANSWER", "--count", "2"});
  ASSERT_TRUE(listener.says("listening to"));
  LcmPublisher publisher({}, Pose());
  ASSERT_TRUE(comesTrue([&] { return publisher.listening(); }));
  lcm::LCM robot;
  send(robot, "SLAM_COMMAND", resetCommand(7));
  command_t senseless = resetCommand(8);
  senseless.command = 99;
  send(robot, "SLAM_COMMAND", senseless);

  std::optional<Command> command;
  ASSERT_TRUE(comesTrue([&] { return (command = publisher.nextCommand()).has_value(); }));
  EXPECT_EQ(command->id, 7);
  EXPECT_EQ(command->kind, CommandKind::reset);
  publisher.answer(*command, true, "begun anew");
  EXPECT_TRUE(comesTrue([&] { return !publisher.nextCommand() && listener.times("#8") > 0; }));
  EXPECT_EQ(listener.exitCode(), 0);
  EXPECT_EQ(listener.times("#7 reset, accepted: begun anew"), 1) << listener.said();
  EXPECT_EQ(listener.times("#8 number 99, refused: command 99 is not known"), 1) << listener.said();
}

TEST_F(LcmNetwork, HostileCommandsAreIgnoredAndCounted) {
  LcmPublisher publisher({}, Pose());
  ASSERT_TRUE(comesTrue([&] { return publisher.listening(); }));
  lcm::LCM attacker;
  send(attacker, "SLAM_COMMAND", pose_t{});
  const std::vector<std::uint8_t> large(200000, 0xff);
  for (const std::size_t bytes : {std::size_t{0}, std::size_t{7}, std::size_t{41}, large.size()}) {
    ASSERT_EQ(attacker.publish("SLAM_COMMAND", large.data(), static_cast<unsigned>(bytes)), 0);
  }
  ASSERT_TRUE(comesTrue([&] { return publisher.counts().commands_ignored >= 5; }));
  EXPECT_FALSE(publisher.nextCommand());

  // A flood that nobody takes in is bounded.
  ASSERT_TRUE(comesTrue([&] {
    for (int i = 0; i < 20; ++i) send(attacker, "SLAM_COMMAND", resetCommand(i));
    return publisher.counts().commands_ignored > 100;
  }));
  int taken = 0;
  while (publisher.nextCommand()) ++taken;
  EXPECT_GT(taken, 0);
  EXPECT_LE(taken, 60) << "16 that waited, and the flood's tail that comes while they are taken";
}

TEST_F(LcmNetwork, NobodyNeedsToListen) {
  LcmPublisher publisher({}, Pose());
  publishFrames(publisher, 300);
  EXPECT_TRUE(comesTrue([&] { return publisher.counts().sent == 1500; }));
  EXPECT_EQ(publisher.counts().not_sent, 0);
}

TEST_F(LcmNetwork, ASubscriberThatNeverReadsStopsNobody) {
  BackgroundProcess frozen({EDGESLAM_PROGRAM, "listen"});
  ASSERT_TRUE(frozen.says("listening to"));
  frozen.freeze();
  BackgroundProcess listener({EDGESLAM_PROGRAM, "listen", "--channel", "SLAM_STATE", "--count", "2000"});
  ASSERT_TRUE(listener.says("listening to"));
  LcmPublisher publisher({}, Pose());
  publishHeard(publisher, 2000, [&](int sent) { return listener.times("SLAM_STATE #") == sent; });
  EXPECT_TRUE(comesTrue([&] { return publisher.counts().sent == 10000; }));
  EXPECT_EQ(listener.exitCode(), 0) << listener.said();
  EXPECT_EQ(listener.times("lost before this"), 0);
}

TEST_F(LcmNetwork, FramesGoOnWhileTheNetworkIsAwayAndAreHeardWhenItIsBack) {
  LcmPublisher publisher({}, Pose());
  ASSERT_TRUE(comesTrue([&] { return publisher.listening(); }));
  publishFrames(publisher, 10);
  ASSERT_TRUE(comesTrue([&] { return publisher.counts().sent == 50; }));

  ASSERT_TRUE(switchNetworkOff());
  publishFrames(publisher, 50, 10);
  EXPECT_TRUE(comesTrue([&] { return publisher.counts().not_sent == 250; }));
  EXPECT_NE(publisher.problem(), "");

  ASSERT_TRUE(switchNetworkOn());
  int frame = 60;
  ASSERT_TRUE(comesTrue([&] {
    publishFrames(publisher, 1, frame++);
    return publisher.problem().empty();
  }));
  BackgroundProcess listener({EDGESLAM_PROGRAM, "listen", "--channel", "SLAM_STATE", "--count", "100"});
  ASSERT_TRUE(listener.says("listening to"));
  publishFrames(publisher, 100, frame);
  EXPECT_EQ(listener.exitCode(), 0) << listener.said();

  lcm::LCM robot;
  std::optional<Command> command;
  EXPECT_TRUE(comesTrue([&] {
    send(robot, "SLAM_COMMAND", resetCommand(3));
    return (command = publisher.nextCommand()).has_value();
  })) << "commands are heard again, too";
}

TEST_F(LcmNetwork, ANetworkThatComesLaterIsUsed) {
  ASSERT_TRUE(switchNetworkOff());
  LcmPublisher publisher({}, Pose());
  publishFrames(publisher, 3);
  EXPECT_TRUE(comesTrue([&] { return publisher.counts().not_sent == 15; }));
  EXPECT_NE(publisher.problem().find("ip route add 224.0.0.0/4 dev lo"), std::string::npos) << publisher.problem();
  ASSERT_TRUE(switchNetworkOn());
  int frame = 3;
  EXPECT_TRUE(comesTrue([&] {
    publishFrames(publisher, 1, frame++);
    return publisher.counts().sent > 0;
  }));
  EXPECT_TRUE(comesTrue([&] { return publisher.listening(); }));
}

TEST_F(LcmNetwork, TheStartCheckFindsAMissingRoute) {
  StartNeeds needs;
  needs.lcm_url = "udpm://239.255.76.67:7667?ttl=1";
  EXPECT_TRUE(startProblems(needs).empty());
  ASSERT_TRUE(switchNetworkOff());
  const std::vector<std::string> problems = startProblems(needs);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_NE(problems[0].find("ip route add 224.0.0.0/4 dev INTERFACE"), std::string::npos) << problems[0];
}

TEST_F(LcmNetwork, ListeningWithoutARouteSaysWhatToDo) {
  ASSERT_TRUE(switchNetworkOff());
  BackgroundProcess listener({EDGESLAM_PROGRAM, "listen"});
  EXPECT_EQ(listener.exitCode(), 2);
  EXPECT_NE(listener.said().find("edgeslam: LCM: no route"), std::string::npos) << listener.said();
  EXPECT_EQ(listener.times("\n"), 1) << "one line: " << listener.said();
}

TEST_F(LcmNetwork, TheControllerHoldsItsPlaceAndStops) {
  BackgroundProcess controller({EDGESLAM_HOLD_POSITION});
  ASSERT_TRUE(controller.says("ready"));
  LcmPublisher publisher({}, Pose());
  const auto show = [&](int index, const Pose& pose) { publisher.frame(measuredFrame(index, pose)); };
  const auto shows = [&](int index, const Pose& pose, const std::string& reaction) {
    return comesTrue([&] {
      show(index, pose);
      return controller.said().find(reaction) != std::string::npos;
    });
  };
  ASSERT_TRUE(shows(0, Pose(), "velocity 0 0 0\n"));
  EXPECT_TRUE(shows(1, {Eigen::Quaterniond::Identity(), {0.1, 0, 0}}, "velocity -0.08 ")) << controller.said();
  // Turned by a quarter about z, what lies ahead in the world is to the right of the body.
  EXPECT_TRUE(shows(2, {rotationExp({0, 0, M_PI / 2}), {0.1, 0, 0}}, " 0.08 ")) << controller.said();
  EXPECT_TRUE(shows(3, {Eigen::Quaterniond::Identity(), {-9, 0, 0}}, "velocity 0.3 ")) << "no faster than allowed";

  FrameResult elsewhere = measuredFrame(3, Pose());
  elsewhere.world = 1;
  publisher.frame(elsewhere);
  EXPECT_TRUE(controller.says("stop: another map")) << controller.said();
  ASSERT_TRUE(shows(3, {Eigen::Quaterniond::Identity(), {0.05, 0, 0}}, "velocity -0.04 ")) << "back in the map";

  publisher.frame(frameWithoutPose(4, TrackingState::lost, "dark"));
  EXPECT_TRUE(controller.says("stop: no measured pose: dark")) << controller.said();
  ASSERT_TRUE(shows(5, {Eigen::Quaterniond::Identity(), {0.2, 0, 0}}, "velocity -0.16 "));
  EXPECT_TRUE(controller.says("stop: silence")) << controller.said();
}

TEST_F(LcmNetwork, ThePythonListenerNeedsTheGeneratedTypesAlone) {
  setenv("PYTHONPATH", EDGESLAM_LCM_PYTHON, 1);
  BackgroundProcess listener({"python3", EDGESLAM_SOURCE_DIR "/drivers/lcm/examples/listen_poses.py"});
  ASSERT_TRUE(listener.says("ready")) << listener.said();
  LcmPublisher publisher({}, Pose());
  publishFrames(publisher, 50);
  EXPECT_TRUE(comesTrue([&] { return listener.times("position") == 50; })) << listener.said();
  EXPECT_NE(listener.said().find("6.633333 s, position (0.49, 0.0, 0.0), quaternion (1.0, 0.0, 0.0, 0.0)"),
            std::string::npos)
      << listener.said();
}

}  // namespace
}  // namespace edgeslam
