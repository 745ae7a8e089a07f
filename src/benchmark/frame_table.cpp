#include "benchmark/frame_table.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "benchmark/json_reader.h"
#include "files/text_file.h"

namespace edgeslam {
namespace {

constexpr std::size_t largest_table = std::size_t{1} << 30U;  // [bytes]

// Takes the rows of RFC 4180 text one after the other.
class CsvRows {
 public:
  CsvRows(const std::string& path, std::string_view text) : path_(path), text_(text) {}

  // False at the end. Views are valid until the next row.
  bool next(std::vector<std::string>& fields) {
    if (at_ >= text_.size()) return false;
    row_line_ = line_;
    fields.assign(1, "");
    while (true) {
      if (at_ >= text_.size()) throw InputError(place() + "the last line is cut off");
      const char c = text_[at_++];
      if (c == '"') {
        readQuoted(fields.back());
      } else if (c == ',') {
        fields.emplace_back();
      } else if (c == '\n') {
        ++line_;
        return true;
      } else if (c != '\r') {
        fields.back() += c;
      }
    }
  }

  // "FILE:LINE: ", of the row taken last.
  std::string place() const { return placeInFile(path_, row_line_); }

 private:
  // From behind the first quote to behind the last one.
  void readQuoted(std::string& field) {
    while (at_ < text_.size()) {
      const char c = text_[at_++];
      if (c == '\n') ++line_;
      if (c != '"') {
        field += c;
      } else if (at_ < text_.size() && text_[at_] == '"') {
        field += text_[at_++];
      } else {
        return;
      }
    }
    throw InputError(place() + "a quoted text does not end");
  }

  const std::string& path_;
  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1, row_line_ = 1;
};

struct Columns {
  std::size_t index = 0, time = 0, state = 0, reason = 0;
  std::array<std::size_t, 7> pose{};         // x y z qx qy qz qw
  std::optional<std::size_t> world;          // of that pose; none in tables of older versions
  std::vector<std::size_t> tracking_stages;  // their times
  std::size_t count = 0;
};

Columns columnsOf(const std::vector<std::string>& heading, const std::string& place) {
  const auto find = [&](const std::string& name) {
    const auto found = std::find(heading.begin(), heading.end(), name);
    if (found == heading.end()) {
      throw InputError(place + "expected a heading with the column " + name + " (a file of another version?)");
    }
    return static_cast<std::size_t>(found - heading.begin());
  };
  Columns columns;
  columns.index = find("index"), columns.time = find("time_s");
  columns.state = find("state"), columns.reason = find("reason");
  const std::array<const char*, 7> values{"x", "y", "z", "qx", "qy", "qz", "qw"};
  for (std::size_t i = 0; i < values.size(); ++i) columns.pose[i] = find(std::string("final_") + values[i]);
  for (std::size_t i = 0; i < heading.size(); ++i) {
    const std::string& name = heading[i];
    if (name == "final_world") columns.world = i;
    const bool is_time = name.size() > 3 && name.compare(name.size() - 3, 3, "_ms") == 0;
    if (is_time && name != "mapping_ms" && name != "places_ms") columns.tracking_stages.push_back(i);
  }
  columns.count = heading.size();
  return columns;
}

double numberIn(const std::string& field, const std::string& column, const std::string& place) {
  const std::optional<double> number = parseNumber(field);
  if (!number || std::abs(*number) > 1e15) {
    throw InputError(place + column + ": expected a number, found '" + field.substr(0, 40) + "'");
  }
  return *number;
}

std::optional<Pose> poseIn(const std::vector<std::string>& fields, const Columns& columns, const std::string& place) {
  if (fields[columns.pose[0]].empty()) return std::nullopt;
  std::array<double, 7> values{};
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = numberIn(fields[columns.pose[i]], "final pose", place);
  Pose pose;
  pose.translation = {values[0], values[1], values[2]};
  pose.rotation = Eigen::Quaterniond(values[6], values[3], values[4], values[5]);
  if (std::abs(pose.rotation.norm() - 1) > 1e-3) {
    throw InputError(place + "final_qx to final_qw: expected a unit quaternion");
  }
  pose.rotation.normalize();
  return pose;
}

// 0 where the table does not tell.
std::int64_t worldIn(const std::vector<std::string>& fields, const Columns& columns, const std::string& place) {
  if (!columns.world || fields[*columns.world].empty()) return 0;
  const auto world = parseNanoseconds(fields[*columns.world]);
  if (!world || *world < 0) throw InputError(place + "final_world: expected a whole number of 0 or more");
  return *world;
}

// `worlds`: of each frame, where it has a pose. Of several with as many poses the earliest number is the main one.
void keepMainWorld(const std::vector<std::int64_t>& worlds, std::vector<FrameRow>& frames) {
  std::map<std::int64_t, std::int64_t> poses;
  for (std::size_t i = 0; i < frames.size(); ++i) poses[worlds[i]] += frames[i].final_pose ? 1 : 0;
  const auto main =
      std::max_element(poses.begin(), poses.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (worlds[i] != main->first) frames[i].final_pose.reset();
  }
}

FrameRow rowOf(const std::vector<std::string>& fields, const Columns& columns, const std::string& place) {
  if (fields.size() != columns.count) {
    throw InputError(place + "expected " + std::to_string(columns.count) + " columns as in the heading, found " +
                     std::to_string(fields.size()));
  }
  FrameRow row;
  const auto index = parseNanoseconds(fields[columns.index]);
  const auto time = parseStamp(fields[columns.time]);
  if (!index || *index < 0) throw InputError(place + "index: expected a whole number of 0 or more");
  if (!time) throw InputError(place + "time_s: expected a time stamp [s]");
  row.index = *index;
  row.time_ns = *time;
  row.state = fields[columns.state];
  row.reason = fields[columns.reason];
  row.final_pose = poseIn(fields, columns, place);
  for (const std::size_t stage : columns.tracking_stages) {
    if (!fields[stage].empty()) row.time_ms += numberIn(fields[stage], "time of a stage", place);
  }
  return row;
}

}  // namespace

std::vector<FrameRow> readFrameTable(const std::string& folder) {
  const std::string path = folder + "/frames.csv";
  const std::string text = readBoundedFile(path, largest_table);
  CsvRows rows(path, text);
  std::vector<std::string> fields;
  if (!rows.next(fields)) throw InputError(path + ":1: expected a heading, but the file is empty");
  const Columns columns = columnsOf(fields, rows.place());
  std::vector<FrameRow> frames;
  std::vector<std::int64_t> worlds;
  while (rows.next(fields)) {
    FrameRow row = rowOf(fields, columns, rows.place());
    if (!frames.empty() && (row.index <= frames.back().index || row.time_ns <= frames.back().time_ns)) {
      throw InputError(rows.place() + "index and time_s must increase");
    }
    frames.push_back(std::move(row));
    worlds.push_back(worldIn(fields, columns, rows.place()));
  }
  keepMainWorld(worlds, frames);
  return frames;
}

Trajectory finalTrajectory(const std::vector<FrameRow>& frames) {
  Trajectory trajectory;
  for (const FrameRow& frame : frames) {
    if (frame.final_pose) trajectory.push_back({frame.time_ns, *frame.final_pose});
  }
  return trajectory;
}

}  // namespace edgeslam
