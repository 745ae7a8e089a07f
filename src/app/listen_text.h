// Messages as lines of text, for people: what `edgeslam listen` prints.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

namespace edgeslam {

// One of our messages, known by its type's hash, in one line without its channel. Others, and messages that cannot be
// decoded, are told as such. Never holds a control character, whatever the bytes are.
std::string describeMessage(const void* data, std::size_t bytes);

// Finds what was lost on the way from the numbers that messages carry.
class GapWatch {
 public:
  // In the order of arrival. Empty, or what is missing before this message: "3 lost before this", "the sender began
  // anew". Messages without a number are never missing.
  std::string add(const std::string& channel, const void* data, std::size_t bytes);

  std::int64_t lost() const { return lost_; }

 private:
  std::map<std::string, std::int64_t> next_;  // by channel
  std::int64_t lost_ = 0;
};

// Messages of the last second, by channel.
class RateWatch {
 public:
  void add(const std::string& channel) { ++counts_[channel]; }
  // "SLAM_POSE 30.0/s, SLAM_STATE 30.0/s" over so many seconds, and begins anew; a channel once heard stays.
  std::string take(double seconds);

 private:
  std::map<std::string, int> counts_;
};

}  // namespace edgeslam
