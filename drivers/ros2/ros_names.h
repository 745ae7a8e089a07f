// Names as ROS 2 has them, and as they go over DDS.
#pragma once

#include <string>

namespace edgeslam {

// "/robot1/odom" for "robot1" and "odom".
std::string rosTopic(const std::string& topic_namespace, const std::string& name);

// DDS's name of a topic: "rt/robot1/odom" for "/robot1/odom".
std::string ddsTopic(const std::string& ros_topic);

// The frame of a map: `map_frame` is world 0. Another world has another origin and unit, and so a frame of its own,
// "map_1": what is in one of them does not go together with what is in the other. A negative `world` is that of no pose
// yet: 0.
std::string mapFrame(const std::string& map_frame, int world);

}  // namespace edgeslam
