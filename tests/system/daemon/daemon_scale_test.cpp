// The metric scale found by the real program on a robot's drive through a corridor, against the simulator's truth.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <thread>

#include "system/daemon/daemon_fixture.h"

namespace edgeslam {
namespace {

// Looks ahead, 0.2 m before and 0.9 m over the body's origin, which is on the ground.
const char* const mounted =
    "camera: {body_T_camera: {translation: [0.2, 0, 0.9], quaternion: [0.5, -0.5, 0.5, -0.5]}}\n";
const Pose body_T_camera{Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5), {0.2, 0, 0.9}};

// Publishes what the wheels of the simulated robot would say, always a little ahead of the frames that were heard.
class Wheels {
 public:
  // `scale`: what they say over what is true. `shift_us`: of their clock.
  Wheels(const Robot& robot, const std::string& sequence, double scale, std::int64_t shift_us = 0)
      : robot_(robot), truth_(readTrajectory(sequence + "/groundtruth.txt")), scale_(scale), shift_us_(shift_us) {
    thread_ = std::thread([this] {
      while (!stopping_) publishDue();
    });
  }
  ~Wheels() {
    stopping_ = true;
    thread_.join();
  }
  Wheels(const Wheels&) = delete;
  Wheels& operator=(const Wheels&) = delete;

 private:
  void publishDue() {
    const std::int64_t frame_us = robot_.latestUtime();
    for (; next_ < truth_.size() && truth_[next_].time_ns / 1000 <= frame_us + 100'000; ++next_) {
      const Pose local_T_body = truth_[next_].world_T_camera * body_T_camera.inverse();
      pose_t message{};
      message.utime = truth_[next_].time_ns / 1000 + shift_us_;
      for (int i = 0; i < 3; ++i) message.pos[i] = scale_ * local_T_body.translation[i];
      const Eigen::Quaterniond& q = local_T_body.rotation;
      const double orientation[4] = {q.w(), q.x(), q.y(), q.z()};
      std::copy_n(orientation, 4, message.orientation);
      lcm_.publish("WHEELS", &message);
      message.pos[0] = NAN;
      lcm_.publish("WHEELS", &message);
      message.utime -= 500'000;
      message.pos[0] = 0;
      lcm_.publish("WHEELS", &message);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }

  const Robot& robot_;
  Trajectory truth_;
  double scale_;
  std::int64_t shift_us_;
  std::size_t next_ = 0;
  lcm::LCM lcm_{"udpm://239.255.76.67:7667?ttl=0"};
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

class DaemonScale : public DaemonTest {
 protected:
  // Metres a map unit along the way over the frames from `first` on.
  double trueScale(const std::vector<state_t>& states) const {
    Trajectory map_units;
    for (const state_t& state : states) {
      if (!isMeasured(state)) continue;
      const double* p = state.camera_position;
      map_units.push_back(
          {state.utime * 1000, {Eigen::Quaterniond::Identity(), Eigen::Vector3d(p[0], p[1], p[2]) / state.scale}});
    }
    return absoluteError(map_units, readTrajectory(drive_ + "/groundtruth.txt"), Alignment::similarity)
        .reference_T_estimate.scale;
  }
  // Of the frames heard; until the recording ends.
  std::vector<state_t> drive(BackgroundProcess& daemon) const {
    EXPECT_EQ(daemon.exitCode(), 0) << daemon.said();
    EXPECT_TRUE(robot_->hearsStatus([](const status_t& status) { return status.frames_captured >= frames; }));
    return robot_->heard().states;
  }
  // Unknown at first, with lengths in map units; then of that kind and true.
  void expectTrueScale(const std::vector<state_t>& states, int kind, const std::string& said) const {
    ASSERT_FALSE(states.empty());
    EXPECT_EQ(states.front().scale_state, state_t::SCALE_UNKNOWN);
    const state_t& last = states.back();
    ASSERT_EQ(last.scale_state, kind) << said;
    EXPECT_GT(last.scale_sigma, 0.005);
    EXPECT_LE(last.scale_sigma, 0.1);
    EXPECT_LT(std::abs(std::log(last.scale / trueScale(states))), 3 * last.scale_sigma) << said;
    double before = 0;
    for (const state_t& state : states) {
      EXPECT_EQ(state.scale_state == state_t::SCALE_UNKNOWN, state.scale_sigma == 0);
      EXPECT_TRUE(state.scale_state != state_t::SCALE_UNKNOWN || state.scale == 1);
      if (before > 0) {
        EXPECT_LE(std::abs(std::log(state.scale / before)), 0.0011) << "no jump";
      }
      before = state.scale_state == state_t::SCALE_UNKNOWN ? 0 : state.scale;
    }
  }

  static constexpr int frames = 300;
  std::string drive_ = std::string(EDGESLAM_RUN_FOLDER) + "/tiled";
};

TEST_F(DaemonScale, ComesFromTheWheels) {
  const std::string configuration =
      configure(std::string(mounted) + "scale: {source: odometry, odometry_channel: WHEELS}\n");
  const auto daemon = startOn(drive_, {"--config", configuration});
  const Wheels wheels(*robot_, drive_, 1.01);
  expectTrueScale(drive(*daemon), state_t::SCALE_FROM_ODOMETRY, daemon->said());
  EXPECT_EQ(daemon->times("metres a map unit"), 1) << "told once: " << daemon->said();
  EXPECT_EQ(robot_->heard().statuses.back().scale_reason, "");
}

TEST_F(DaemonScale, OfWheelsOfAnotherClockIsNotTakenAndTold) {
  const std::string configuration =
      configure(std::string(mounted) + "scale: {source: odometry, odometry_channel: WHEELS}\n");
  const auto daemon = startOn(drive_, {"--config", configuration});
  const Wheels wheels(*robot_, drive_, 1, 3'600'000'000);
  ASSERT_TRUE(robot_->hearsStatus([](const status_t& status) {
    return status.scale_reason.find("both must be CLOCK_MONOTONIC") != std::string::npos;
  })) << daemon->said();
  for (const state_t& state : drive(*daemon)) ASSERT_EQ(state.scale_state, state_t::SCALE_UNKNOWN);
}

TEST_F(DaemonScale, ComesFromTheCamerasHeight) {
  const std::string configuration =
      configure(std::string(mounted) + "scale: {source: camera_height, camera_height_m: 0.9}\n");
  // A drive lasts 10 s, the ground is known after 6 to 7 of them, but not in every one: it is refused where points lie
  // below what is taken for it.
  std::vector<state_t> states;
  std::string said;
  for (const char* recording : {"tiled_again", "tiled_once_more", "tiled"}) {
    robot_ = std::make_unique<Robot>();
    drive_ = std::string(EDGESLAM_RUN_FOLDER) + "/" + recording;
    const auto daemon = startOn(drive_, {"--config", configuration});
    states = drive(*daemon);
    said = daemon->said();
    ASSERT_FALSE(states.empty());
    if (states.back().scale_state != state_t::SCALE_UNKNOWN) break;
    // It may come to be known as the recording ends.
    const std::vector<status_t> statuses = robot_->heard().statuses;
    ASSERT_TRUE(
        std::any_of(statuses.begin(), statuses.end(), [](const status_t& s) { return !s.scale_reason.empty(); }))
        << "why it is not known is told: " << said;
  }
  expectTrueScale(states, state_t::SCALE_FROM_CAMERA_HEIGHT, said);
}

TEST_F(DaemonScale, WithoutAGroundStaysUnknownAndWhyIsTold) {
  // The camera is taken to look down.
  const std::string configuration = configure(
      "camera: {body_T_camera: {translation: [0, 0, 0.9], quaternion: [0, 1, 0, 0]}}\n"
      "scale: {source: camera_height, camera_height_m: 0.9}\n");
  const auto daemon = startOn(drive_, {"--config", configuration});
  for (const state_t& state : drive(*daemon)) ASSERT_EQ(state.scale_state, state_t::SCALE_UNKNOWN);
  EXPECT_TRUE(robot_->hearsStatus([](const status_t& status) { return !status.scale_reason.empty(); }));
  EXPECT_TRUE(daemon->says("the scale is not known yet: ")) << daemon->said();
}

}  // namespace
}  // namespace edgeslam
