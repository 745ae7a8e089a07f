// The robot's side: hears what the daemon publishes, and sends it commands.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "edgeslam/command_answer_t.hpp"
#include "edgeslam/command_t.hpp"
#include "edgeslam/correction_t.hpp"
#include "edgeslam/map_lines_t.hpp"
#include "edgeslam/map_part_t.hpp"
#include "edgeslam/pose_t.hpp"
#include "edgeslam/state_t.hpp"
#include "edgeslam/status_t.hpp"
#include "edgeslam/update_t.hpp"
#include "evaluation/trajectory.h"
#include "unit/lcm/comes_true.h"

namespace edgeslam {

struct Heard {
  std::vector<state_t> states;
  std::vector<status_t> statuses;
  std::vector<pose_t> poses;
  std::vector<update_t> updates;
  std::vector<pose_t> odometry;
  std::vector<correction_t> corrections;
  std::vector<map_part_t> map_parts;
  std::vector<map_lines_t> line_parts;
  std::map<std::int64_t, command_answer_t> answers;  // by the command's number
};

class Robot {
 public:
  Robot() : lcm_("udpm://239.255.76.67:7667?ttl=0&recv_buf_size=2000000") {
    hear("SLAM_STATE", &Robot::take<state_t, &Heard::states>);
    hear("SLAM_STATUS", &Robot::take<status_t, &Heard::statuses>);
    hear("SLAM_POSE", &Robot::take<pose_t, &Heard::poses>);
    hear("SLAM_REL_ODOMETRY", &Robot::take<update_t, &Heard::updates>);
    hear("SLAM_ODOMETRY", &Robot::take<pose_t, &Heard::odometry>);
    hear("SLAM_CORRECTION", &Robot::take<correction_t, &Heard::corrections>);
    hear("SLAM_MAP", &Robot::take<map_part_t, &Heard::map_parts>);
    hear("SLAM_MAP_LINES", &Robot::take<map_lines_t, &Heard::line_parts>);
    hear("SLAM_ANSWER", &Robot::takeAnswer);
    thread_ = std::thread([this] {
      while (!stopping_) lcm_.handleTimeout(50);
    });
  }
  ~Robot() {
    stopping_ = true;
    thread_.join();
  }
  Robot(const Robot&) = delete;
  Robot& operator=(const Robot&) = delete;

  Heard heard() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return heard_;
  }
  // Of the latest state; 0 before the first.
  std::int64_t latestUtime() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return heard_.states.empty() ? 0 : heard_.states.back().utime;
  }
  bool hears(const std::function<bool(const Heard&)>& what) const {
    return comesTrue([&] {
      const std::lock_guard<std::mutex> lock(mutex_);
      return what(heard_);
    });
  }
  bool hearsState(const std::function<bool(const state_t&)>& what) const {
    return hears([&](const Heard& heard) { return !heard.states.empty() && what(heard.states.back()); });
  }
  bool hearsStatus(const std::function<bool(const status_t&)>& what) const {
    return hears([&](const Heard& heard) { return !heard.statuses.empty() && what(heard.statuses.back()); });
  }

  // The answer, sent again until there is one: a daemon that was just started does not hear yet.
  command_answer_t ask(command_t command) {
    command.id = ++commands_;
    const bool answered = comesTrue([&] {
      lcm_.publish("SLAM_COMMAND", &command);
      for (int i = 0; i < 20; ++i) {
        if (heard().answers.count(command.id) > 0) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
      }
      return false;
    });
    EXPECT_TRUE(answered) << "command " << static_cast<int>(command.command) << " is not answered";
    return heard().answers[command.id];
  }
  command_answer_t ask(int kind) {
    command_t command{};
    command.command = static_cast<std::int8_t>(kind);
    return ask(command);
  }

 private:
  template <class Message>
  void hear(const char* channel, void (Robot::*taker)(const lcm::ReceiveBuffer*, const std::string&, const Message*)) {
    lcm_.subscribe(channel, taker, this)->setQueueCapacity(5000);
  }
  template <class Message, std::vector<Message> Heard::*list>
  void take(const lcm::ReceiveBuffer*, const std::string&, const Message* message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    (heard_.*list).push_back(*message);
  }
  void takeAnswer(const lcm::ReceiveBuffer*, const std::string&, const command_answer_t* answer) {
    const std::lock_guard<std::mutex> lock(mutex_);
    heard_.answers[answer->id] = *answer;
  }

  mutable std::mutex mutex_;
  Heard heard_;
  lcm::LCM lcm_;
  std::int64_t commands_ = 0;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

inline bool isMeasured(const state_t& state) {
  return state.has_pose &&
         (state.state == state_t::TRACKING || state.state == state_t::RECOVERED || state.state == state_t::RELOCALISED);
}

// Of the camera, measured poses only.
inline Trajectory trajectoryOf(const std::vector<state_t>& states) {
  Trajectory trajectory;
  for (const state_t& state : states) {
    if (!isMeasured(state)) continue;
    const double* q = state.camera_orientation;
    const double* p = state.camera_position;
    trajectory.push_back({state.utime * 1000, {Eigen::Quaterniond(q[0], q[1], q[2], q[3]), {p[0], p[1], p[2]}}});
  }
  return trajectory;
}

}  // namespace edgeslam
