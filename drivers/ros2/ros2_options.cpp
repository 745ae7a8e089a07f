#include "drivers/ros2/ros2_options.h"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace edgeslam {
namespace {

constexpr int largest_domain = 232;           // beyond it, ports of UDP do not suffice
constexpr std::size_t longest_name = 200;     // DDS carries 255 bytes of a topic's name
constexpr std::size_t longest_domain_id = 3;  // [digits]

bool isDigit(char c) { return c >= '0' && c <= '9'; }
bool isLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

// Words of letters, digits and single underscores that begin with none of the digits, with a slash between them.
bool isNamespace(const std::string& name) {
  char before = '/';
  for (const char c : name) {
    const bool begins = before == '/';
    if (c == '/' ? begins : !(isLetter(c) || c == '_' || (isDigit(c) && !begins))) return false;
    if (c == '_' && before == '_') return false;
    before = c;
  }
  return before != '/' && name.size() <= longest_name;
}

bool isFrame(const std::string& name) {
  const bool plain = std::all_of(name.begin(), name.end(), [](char c) {
    return isLetter(c) || isDigit(c) || c == '_' || c == '-' || c == '.' || c == '/';
  });
  return plain && !name.empty() && name.front() != '/' && name.size() <= longest_name;
}

}  // namespace

std::string ros2Problem(const Ros2Options& options) {
  const std::string& name = options.topic_namespace;
  if (!name.empty() && !isNamespace(name)) {
    return "ros2.namespace: '" + name + "' is none; expected words of letters, digits and underscores, as robot1 or " +
           "fleet/robot1, without a slash at its ends";
  }
  if (options.transforms != "all" && options.transforms != "map_to_odom" && options.transforms != "none") {
    return "ros2.transforms: '" + options.transforms + "' is not known; expected all, map_to_odom or none";
  }
  const std::array<std::pair<const char*, const std::string*>, 3> frames{
      {{"map_frame", &options.map_frame}, {"odom_frame", &options.odom_frame}, {"body_frame", &options.body_frame}}};
  for (const auto& [key, frame] : frames) {
    if (isFrame(*frame)) continue;
    return std::string("ros2.") + key + ": '" + *frame +
           "' is no frame; expected letters, digits and _ - . /, and no slash at the start";
  }
  if (options.map_frame == options.odom_frame || options.odom_frame == options.body_frame ||
      options.body_frame == options.map_frame) {
    return "ros2.map_frame, ros2.odom_frame and ros2.body_frame: two are the same; expected three names";
  }
  return "";
}

int effectiveDomain(const Ros2Options& options) {
  if (options.domain >= 0) return options.domain;
  const char* environment = std::getenv("ROS_DOMAIN_ID");
  const std::string number = environment ? environment : "";
  if (number.empty()) return 0;
  const bool is_number = number.size() <= longest_domain_id && std::all_of(number.begin(), number.end(), isDigit);
  if (!is_number || std::stoi(number) > largest_domain) {
    throw InputError("ROS_DOMAIN_ID '" + number + "' is no domain; expected 0 to 232");
  }
  return std::stoi(number);
}

}  // namespace edgeslam
