#include "app/listen_text.h"

#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <exception>
#include <optional>

#include "drivers/lcm/messages.h"
#include "edgeslam/command_answer_t.hpp"
#include "edgeslam/command_t.hpp"
#include "edgeslam/correction_t.hpp"
#include "edgeslam/map_lines_t.hpp"
#include "edgeslam/map_part_t.hpp"
#include "edgeslam/status_t.hpp"

namespace edgeslam {
namespace {

// printf into a string; long ones are cut.
__attribute__((format(printf, 1, 2))) std::string line(const char* format, ...) {
  std::array<char, 600> text{};
  va_list values;
  va_start(values, format);
  std::vsnprintf(text.data(), text.size(), format, values);
  va_end(values);
  return text.data();
}

template <std::size_t size>
std::string nameOf(const std::array<const char*, size>& names, int number) {
  if (number >= 0 && number < static_cast<int>(size)) return names[static_cast<std::size_t>(number)];
  return "number " + std::to_string(number);
}

std::string stateText(int state) {
  return nameOf<6>({"initialising", "tracking", "predicted", "recovered", "relocalised", "lost"}, state);
}

std::string scaleText(int kind, double scale, double sigma) {
  if (kind == state_t::SCALE_UNKNOWN) return "scale unknown";
  return "scale " + line("%.4g m/unit +- %.1f %%", scale, 100 * sigma);
}

std::string reasonText(const std::string& reason) { return reason.empty() ? "" : ": " + messageText(reason); }

double secondsOfUtime(std::int64_t utime) { return 1e-6 * static_cast<double>(utime); }

std::string poseText(const double (&p)[3], const double (&q)[4]) {
  return line("at %.3f %.3f %.3f, turned %.4f %.4f %.4f %.4f", p[0], p[1], p[2], q[0], q[1], q[2], q[3]);
}

std::string describe(const pose_t& pose) {
  return line("t %.6f s, ", secondsOfUtime(pose.utime)) + poseText(pose.pos, pose.orientation) +
         line(", velocity %.3f %.3f %.3f /s", pose.vel[0], pose.vel[1], pose.vel[2]);
}

std::string describe(const state_t& state) {
  std::string text = line("#%lld t %.6f s, ", static_cast<long long>(state.sequence), secondsOfUtime(state.utime)) +
                     stateText(state.state) + reasonText(state.reason);
  if (state.has_pose) text += line(", world %d, ", state.world) + poseText(state.position, state.orientation);
  return text +
         line(", points %d of %d, latency %.1f ms, ", state.points_mapped, state.points_tracked, state.latency_ms) +
         scaleText(state.scale_state, state.scale, state.scale_sigma);
}

std::string describe(const update_t& update) {
  const std::string status = nameOf<5>(
      {"no data", "valid", "insufficient features", "degenerate", "reprojection error"}, update.estimate_status);
  if (update.estimate_status != update_t::ESTIMATE_VALID) {
    return line("t %.6f s, ", secondsOfUtime(update.timestamp)) + status;
  }
  return line("t %.6f s, %s, in %.1f ms moved %.4f %.4f %.4f", secondsOfUtime(update.timestamp), status.c_str(),
              1e3 * (secondsOfUtime(update.timestamp) - secondsOfUtime(update.prev_timestamp)), update.translation[0],
              update.translation[1], update.translation[2]);
}

std::string describe(const correction_t& correction) {
  const std::string why =
      nameOf<7>({"start", "map adjusted", "map corrected", "found again", "measured again", "another world", "scale"},
                correction.change);
  return line("t %.6f s, world %d, ", secondsOfUtime(correction.utime), correction.world) +
         poseText(correction.translation, correction.rotation) +
         line(", changed at %.6f s: %s, resets %d%s", secondsOfUtime(correction.change_utime), why.c_str(),
              correction.reset_count, correction.is_measured ? "" : ", not measured");
}

std::string describe(const status_t& status) {
  return line("#%lld ", static_cast<long long>(status.sequence)) + stateText(status.state) + reasonText(status.reason) +
         line(
             ", %.1f frames/s, %.1f poses/s, latency %.1f ms (99 %%: %.1f), dropped %lld, keyframes %d, points %d, "
             "maps %d, loops %d, %.0f MB, %.0f C, not sent %lld",
             status.frames_per_second, status.poses_per_second, status.latency_p50_ms, status.latency_p99_ms,
             static_cast<long long>(status.frames_dropped), status.keyframes, status.points, status.worlds,
             status.loops, 1e-6 * static_cast<double>(status.memory_bytes), status.temperature_c,
             static_cast<long long>(status.messages_not_sent)) +
         (status.scale_reason.empty() ? "" : ", scale: " + messageText(status.scale_reason));
}

// What parts of points and of lines share.
template <class Part>
std::string partText(const Part& part) {
  return line("version %lld, part %d of %d, ", static_cast<long long>(part.version), part.part + 1, part.parts);
}

std::string describe(const map_part_t& map) {
  return partText(map) + line("%d of %d points", map.points, map.points_in_map);
}

std::string describe(const map_lines_t& map) {
  return partText(map) + line("%d of %d lines", map.lines, map.lines_in_map);
}

std::string commandText(int command) {
  return nameOf<7>({"number 0", "reset", "save map", "start recording", "stop recording", "set scale", "send map"},
                   command);
}

std::string describe(const command_t& command) {
  return line("#%lld ", static_cast<long long>(command.id)) + commandText(command.command);
}

std::string describe(const command_answer_t& answer) {
  return line("#%lld ", static_cast<long long>(answer.id)) + commandText(answer.command) +
         (answer.accepted ? ", accepted" : ", refused") + reasonText(answer.message);
}

std::int64_t hashOf(const void* data, std::size_t bytes) {
  std::int64_t hash = 0;
  if (bytes < 8) return hash;
  for (int i = 0; i < 8; ++i) {
    hash =
        static_cast<std::int64_t>((static_cast<std::uint64_t>(hash) << 8) | static_cast<const std::uint8_t*>(data)[i]);
  }
  return hash;
}

// None where the bytes are not exactly one message of the type.
template <class Message>
std::optional<Message> decoded(const void* data, std::size_t bytes) {
  if (hashOf(data, bytes) != Message::getHash() || bytes > (1U << 20)) return std::nullopt;
  try {
    Message message;
    const int size = static_cast<int>(bytes);
    if (message.decode(data, 0, size) == size) return message;
  } catch (const std::exception&) {  // lcm-gen's code throws for a negative length
  }
  return std::nullopt;
}

// True where the type was this one; `text` then says what the message is.
template <class Message>
bool describeAs(const void* data, std::size_t bytes, std::string& text) {
  if (hashOf(data, bytes) != Message::getHash()) return false;
  const std::optional<Message> message = decoded<Message>(data, bytes);
  text = message ? describe(*message) : line("malformed %s of %zu bytes", Message::getTypeName(), bytes);
  return true;
}

template <class... Messages>
bool describeAsOneOf(const void* data, std::size_t bytes, std::string& text) {
  return (describeAs<Messages>(data, bytes, text) || ...);
}

std::optional<std::int64_t> sequenceOf(const void* data, std::size_t bytes) {
  if (const auto state = decoded<state_t>(data, bytes)) return state->sequence;
  if (const auto status = decoded<status_t>(data, bytes)) return status->sequence;
  return std::nullopt;
}

}  // namespace

std::string describeMessage(const void* data, std::size_t bytes) {
  std::string text;
  const bool is_known = describeAsOneOf<pose_t, state_t, update_t, correction_t, status_t, map_part_t, map_lines_t,
                                        command_t, command_answer_t>(data, bytes, text);
  return is_known ? text : line("%zu bytes of a type that is not ours", bytes);
}

std::string GapWatch::add(const std::string& channel, const void* data, std::size_t bytes) {
  const std::optional<std::int64_t> sequence = sequenceOf(data, bytes);
  if (!sequence || *sequence < 0) return "";
  const auto known = next_.find(channel);
  const std::int64_t expected = known == next_.end() ? *sequence : known->second;
  next_[channel] = *sequence + 1;
  if (*sequence == expected) return "";
  if (*sequence < expected) return "the sender began anew, or messages overtook each other";
  lost_ += *sequence - expected;
  return std::to_string(*sequence - expected) + " lost before this";
}

std::string RateWatch::take(double seconds) {
  std::string text;
  for (auto& [channel, count] : counts_) {
    text += (text.empty() ? "" : ", ") + messageText(channel) + line(" %.1f/s", count / seconds);
    count = 0;
  }
  return text.empty() ? "nothing" : text;
}

}  // namespace edgeslam
