#include "recording/recording_layout.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <system_error>
#include <vector>

#include "edgeslam/input_error.h"
#include "files/format_text.h"
#include "files/text_file.h"
#include "inertia/inertial_history.h"
#include "wheels/utime.h"

namespace edgeslam {
namespace {

constexpr std::size_t longest_text = 500;  // [bytes]
constexpr std::size_t checksum_digits = 8;
constexpr std::int64_t largest_value = 4'000'000'000'000'000'000;

// Which values a kind of line has; they come in this order.
struct LineForm {
  DecisionKind kind;
  std::string_view word;
  std::int64_t Decision::*first;   // null: none
  std::int64_t Decision::*second;  // null: none
  bool has_text;
  const char* expected;
};

constexpr std::array<LineForm, 11> line_forms{{
    {DecisionKind::frame, "frame", &Decision::index, &Decision::time_ns, true,
     "frame INDEX TIME_NS OFFSET SIZE CHECKSUM"},
    {DecisionKind::dropped, "dropped", &Decision::index, &Decision::time_ns, false, "dropped INDEX TIME_NS"},
    {DecisionKind::unreadable, "unreadable", &Decision::index, &Decision::time_ns, true,
     "unreadable INDEX TIME_NS REASON"},
    {DecisionKind::update, "update", &Decision::index, &Decision::number, false, "update INDEX NUMBER"},
    {DecisionKind::inertia, "inertia", &Decision::index, &Decision::time_ns, true,
     "inertia INDEX TIME_NS RATE RATE RATE FORCE FORCE FORCE"},
    {DecisionKind::wheels, "wheels", &Decision::index, &Decision::time_ns, true, "wheels INDEX TIME_NS X Y Z W X Y Z"},
    {DecisionKind::busy, "busy", &Decision::index, nullptr, false, "busy INDEX"},
    {DecisionKind::correction, "correction", &Decision::index, &Decision::number, false, "correction MESSAGE NUMBER"},
    {DecisionKind::gap, "gap", &Decision::number, nullptr, false, "gap COUNT"},
    {DecisionKind::stopped, "stopped", nullptr, nullptr, true, "stopped REASON"},
    {DecisionKind::end, "end", nullptr, nullptr, false, "end"},
}};

bool isControl(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

std::string withoutControls(std::string_view text) {
  std::string plain(text.substr(0, longest_text));
  std::replace_if(plain.begin(), plain.end(), isControl, ' ');
  return plain;
}

std::string checksum(std::string_view text) {
  const auto value = crc32_z(0, reinterpret_cast<const Bytef*>(text.data()), text.size());
  return formatted("%08lx", static_cast<unsigned long>(value));
}

std::optional<std::uint32_t> checksumOf(std::string_view digits) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
  if (error != std::errc() || end != digits.data() + digits.size() || digits.size() != checksum_digits) return {};
  return value;
}

// None where the text is not just so many.
template <std::size_t count>
std::optional<std::array<double, count>> numbersOf(const std::string& text) {
  const std::vector<std::string_view> columns = splitColumns(text);
  if (columns.size() != count) return std::nullopt;
  std::array<double, count> numbers{};
  for (std::size_t i = 0; i < count; ++i) {
    const std::optional<double> number = parseNumber(columns[i]);
    if (!number) return std::nullopt;
    numbers[i] = *number;
  }
  return numbers;
}

// The text up to the next blank, which is taken off together with that blank.
std::string_view takeWord(std::string_view& text) {
  const std::size_t blank = text.find(' ');
  const std::string_view word = text.substr(0, blank);
  text.remove_prefix(blank == std::string_view::npos ? text.size() : blank + 1);
  return word;
}

}  // namespace

std::int64_t largestArchivedImage(int width, int height) {
  constexpr std::int64_t most_around = 1 << 16, most_a_pixel = 2;
  return most_around + most_a_pixel * width * height;
}

Decision frameDecision(std::int64_t index, std::int64_t time_ns, const ArchivedImage& image) {
  return {DecisionKind::frame, index, time_ns, 0,
          std::to_string(image.offset) + " " + std::to_string(image.size) + " " + formatted("%08x", image.checksum)};
}

std::optional<ArchivedImage> archivedImageOf(const Decision& decision) {
  const std::vector<std::string_view> columns = splitColumns(decision.text);
  if (decision.kind != DecisionKind::frame || columns.size() != 3) return std::nullopt;
  const auto offset = parseNanoseconds(columns[0]), size = parseNanoseconds(columns[1]);
  const auto checksum = checksumOf(columns[2]);
  if (!offset || *offset < 0 || !size || *size < 1 || !checksum) return std::nullopt;
  return ArchivedImage{*offset, *size, *checksum};
}

Decision inertiaDecision(std::int64_t frame_index, const InertialSample& sample) {
  const Eigen::Vector3d &rate = sample.rate, &force = sample.force;
  return {
      DecisionKind::inertia, frame_index, sample.time_ns, 0,
      formatted("%.17g %.17g %.17g %.17g %.17g %.17g", rate.x(), rate.y(), rate.z(), force.x(), force.y(), force.z())};
}

std::optional<InertialSample> inertialSampleOf(const Decision& decision) {
  const std::optional<std::array<double, 6>> numbers = numbersOf<6>(decision.text);
  if (!numbers) return std::nullopt;
  const auto& [rate_x, rate_y, rate_z, force_x, force_y, force_z] = *numbers;
  const InertialSample sample{decision.time_ns, {rate_x, rate_y, rate_z}, {force_x, force_y, force_z}};
  return isUsable(sample) ? std::optional(sample) : std::nullopt;
}

Decision wheelsDecision(std::int64_t frame_index, const OdometryPose& pose) {
  const Eigen::Vector3d& t = pose.local_T_body.translation;
  const Eigen::Quaterniond& q = pose.local_T_body.rotation;
  return {DecisionKind::wheels, frame_index, timeOf(pose), 0,
          formatted("%.17g %.17g %.17g %.17g %.17g %.17g %.17g", t.x(), t.y(), t.z(), q.w(), q.x(), q.y(), q.z())};
}

std::optional<OdometryPose> odometryPoseOf(const Decision& decision) {
  const std::optional<std::array<double, 7>> numbers = numbersOf<7>(decision.text);
  if (!numbers) return std::nullopt;
  const auto& [x, y, z, turn_w, turn_x, turn_y, turn_z] = *numbers;
  const OdometryPose pose{utimeOf(decision.time_ns), {{turn_w, turn_x, turn_y, turn_z}, {x, y, z}}};
  return isUsable(pose) ? std::optional(pose) : std::nullopt;
}

std::string formatDecision(const Decision& decision) {
  const LineForm& form = *std::find_if(line_forms.begin(), line_forms.end(),
                                       [&](const LineForm& candidate) { return candidate.kind == decision.kind; });
  std::string line(form.word);
  for (const std::int64_t Decision::*const value : {form.first, form.second}) {
    if (value) line.append(" ").append(std::to_string(decision.*value));
  }
  if (form.has_text) line.append(" ").append(withoutControls(decision.text));
  const std::string digits = checksum(line);
  return line.append(" ").append(digits).append("\n");
}

std::optional<std::string_view> undamagedDecision(std::string_view line) {
  if (line.size() < checksum_digits + 1) return std::nullopt;
  const std::string_view text = line.substr(0, line.size() - checksum_digits - 1);
  if (line.substr(text.size()) != " " + checksum(text)) return std::nullopt;
  return text;
}

Decision parseDecision(std::string_view text, const std::string& place) {
  const std::string found = withoutControls(text);
  std::string_view rest = text;
  const std::string_view word = takeWord(rest);
  const auto* const form = std::find_if(line_forms.begin(), line_forms.end(),
                                        [&](const LineForm& candidate) { return candidate.word == word; });
  if (form == line_forms.end()) {
    throw InputError(
        place +
        "expected frame, dropped, unreadable, update, inertia, wheels, busy, correction, gap, stopped or end, found '" +
        found + "'");
  }
  const auto wrongForm = [&] {
    return InputError(place + "expected '" + form->expected + "', numbers whole and of 0 to 4e18, found '" + found +
                      "'");
  };
  Decision decision;
  decision.kind = form->kind;
  for (std::int64_t Decision::*const value : {form->first, form->second}) {
    if (!value) continue;
    const std::optional<std::int64_t> number = parseNanoseconds(takeWord(rest));
    if (!number || *number < 0) throw wrongForm();
    decision.*value = *number;
  }
  const bool text_fits = form->has_text ? rest.size() <= longest_text : rest.empty();
  if (!text_fits || std::any_of(text.begin(), text.end(), isControl)) throw wrongForm();
  decision.text = rest;
  return decision;
}

std::string DecisionOrder::add(const Decision& decision) {
  const auto goesBack = [](const char* what, std::int64_t value, std::int64_t before) {
    return std::string(what) + " " + std::to_string(value) + " comes after " + std::to_string(before) +
           "; it must increase";
  };
  if (ended_) return "nothing can follow the end of the recording";
  for (const std::int64_t value : {decision.index, decision.time_ns, decision.number}) {
    if (value < 0 || value > largest_value) return std::to_string(value) + " is not in 0 to 4e18";
  }
  switch (decision.kind) {
    case DecisionKind::frame:
    case DecisionKind::dropped:
    case DecisionKind::unreadable:
      if (decision.index <= index_) return goesBack("the frame's index", decision.index, index_);
      if (decision.kind != DecisionKind::dropped && decision.time_ns <= time_ns_) {
        return goesBack("the frame's time stamp [ns]", decision.time_ns, time_ns_);
      }
      if (const auto image = archivedImageOf(decision)) {
        if (image->offset < archive_end_) return goesBack("the image's place [byte]", image->offset, archive_end_ - 1);
        archive_end_ = image->offset + image->size;
      }
      if (decision.kind != DecisionKind::dropped) time_ns_ = decision.time_ns;
      index_ = decision.index;
      break;
    case DecisionKind::update:
      if (decision.index < update_index_) return goesBack("the update's frame", decision.index, update_index_);
      if (decision.number <= update_number_) return goesBack("the update", decision.number, update_number_);
      update_index_ = decision.index;
      update_number_ = decision.number;
      break;
    case DecisionKind::inertia:
      if (decision.index < inertia_index_) return goesBack("inertia's frame", decision.index, inertia_index_);
      inertia_index_ = decision.index;
      break;
    case DecisionKind::wheels:
      if (decision.index < wheels_index_) return goesBack("the wheels' frame", decision.index, wheels_index_);
      wheels_index_ = decision.index;
      break;
    case DecisionKind::busy:
      if (decision.index <= busy_index_) return goesBack("the busy frame", decision.index, busy_index_);
      busy_index_ = decision.index;
      break;
    case DecisionKind::correction:
      if (decision.index < correction_message_) {
        return goesBack("the correction's message", decision.index, correction_message_);
      }
      if (decision.number <= correction_number_) {
        return goesBack("the correction", decision.number, correction_number_);
      }
      correction_message_ = decision.index;
      correction_number_ = decision.number;
      break;
    case DecisionKind::gap:
      break;
    case DecisionKind::stopped:
    case DecisionKind::end:
      ended_ = true;
      break;
  }
  return "";
}

}  // namespace edgeslam
