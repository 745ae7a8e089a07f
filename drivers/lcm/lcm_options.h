// How the publisher is reached: LCM's URL, its reach, the channels' names; all checked before anything is opened.
#pragma once

#include <optional>
#include <string>

#include "edgeslam/input_error.h"

namespace edgeslam {

struct LcmOptions {
  // provider://network?option=value&...; empty: the environment's LCM_DEFAULT_URL, or LCM's own default
  std::string url;
  // of multicast packets: 0 stays on this host, 1 reaches the local network; -1: as the URL says
  int time_to_live = -1;
  // of the thread that sends: SCHED_FIFO, 1 to 99, where it is allowed; 0: the usual scheduling
  int real_time_priority = 0;
  std::string pose_channel = "SLAM_POSE";
  std::string odometry_channel = "SLAM_REL_ODOMETRY";
  std::string odom_channel = "SLAM_ODOMETRY";
  std::string correction_channel = "SLAM_CORRECTION";
  std::string state_channel = "SLAM_STATE";
  std::string status_channel = "SLAM_STATUS";
  std::string map_channel = "SLAM_MAP";
  std::string map_lines_channel = "SLAM_MAP_LINES";
  std::string command_channel = "SLAM_COMMAND";
  std::string answer_channel = "SLAM_ANSWER";
  // of the robot's wheel odometry (pose_t), which is listened to; empty: none
  std::string wheels_channel;
  // of the robot's inertial unit (imu_t or ins_t), likewise
  std::string imu_channel;
};

struct MulticastGroup {
  std::string address = "239.255.76.67";  // LCM's defaults
  int port = 7667;
  int time_to_live = 0;
};

// The URL in effect, time to live included. Throws InputError where it cannot be one.
std::string effectiveUrl(const LcmOptions& options);

// Throws InputError for a channel's name that LCM cannot carry or that others would take for a pattern, and for two
// channels of the same name.
void checkChannels(const LcmOptions& options);

// Of a udpm:// URL; none for another provider. Throws InputError where it cannot be one.
std::optional<MulticastGroup> multicastGroup(const std::string& url);

// True where messages can be received by this URL: not from a file that is written, nor from another program's memory.
bool canReceive(const std::string& url);

// Empty where packets to the group can be sent; or why not and what to do, in one line.
std::string multicastRouteProblem(const MulticastGroup& group);

}  // namespace edgeslam
