// What ROS 2 programs hear of the run, and under which names; all checked before anything is opened.
#pragma once

#include <string>

#include "edgeslam/input_error.h"

namespace edgeslam {

struct Ros2Options {
  bool enabled = false;
  int domain = -1;                 // 0 to 232; -1: the environment's ROS_DOMAIN_ID, or 0
  std::string topic_namespace;     // before the names of odom, pose and map_points: "robot1", "fleet/robot1"; or empty
  std::string transforms = "all";  // all: map -> odom -> body; map_to_odom: another node has the second; none
  std::string map_frame = "map";
  std::string odom_frame = "odom";
  std::string body_frame = "base_link";
};

// Empty, or what is wrong with the key of that name: "ros2.namespace: ...".
std::string ros2Problem(const Ros2Options& options);

// The domain in effect. Throws InputError where ROS_DOMAIN_ID counts and is none.
int effectiveDomain(const Ros2Options& options);

}  // namespace edgeslam
