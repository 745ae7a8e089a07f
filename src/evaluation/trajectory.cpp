#include "evaluation/trajectory.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "edgeslam/input_error.h"
#include "files/text_file.h"

namespace edgeslam {
namespace {

constexpr double largest_position = 1e12;  // its square and cube are still far from infinity

StampedPose parsePose(const std::string& path, const TextLine& line) {
  // EuRoC's files are comma separated, with the quaternion's w first; TUM's are blank separated, with it last.
  const bool is_euroc = line.text.find(',') != std::string::npos;
  const std::vector<std::string_view> columns = splitColumns(line.text);
  if (columns.size() < 8) {
    throw InputError(placeInFile(path, line.number) + "expected 8 columns (" +
                     (is_euroc ? "time [ns], x, y, z, qw, qx, qy, qz" : "time [s] tx ty tz qx qy qz qw") + "), found " +
                     std::to_string(columns.size()));
  }
  StampedPose stamped;
  const std::optional<std::int64_t> time = is_euroc ? parseNanoseconds(columns[0]) : parseStamp(columns[0]);
  if (!time) {
    throw InputError(placeInFile(path, line.number) + "'" + std::string(columns[0]) + "' is not a time stamp [" +
                     (is_euroc ? "ns]" : "s]"));
  }
  stamped.time_ns = *time;
  std::array<double, 7> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::optional<double> value = parseNumber(columns[i + 1]);
    if (!value) {
      throw InputError(placeInFile(path, line.number) + "column " + std::to_string(i + 2) + ": '" +
                       std::string(columns[i + 1]) + "' is not a finite number");
    }
    values[i] = *value;
  }
  stamped.world_T_camera.translation = {values[0], values[1], values[2]};
  if (stamped.world_T_camera.translation.cwiseAbs().maxCoeff() > largest_position) {
    throw InputError(placeInFile(path, line.number) + "the position is beyond 1e12");
  }
  const Eigen::Quaterniond rotation = is_euroc ? Eigen::Quaterniond(values[3], values[4], values[5], values[6])
                                               : Eigen::Quaterniond(values[6], values[3], values[4], values[5]);
  if (!(rotation.coeffs().stableNorm() > 1e-6)) {
    throw InputError(placeInFile(path, line.number) + "the quaternion is zero");
  }
  // The length itself may be beyond the largest number.
  const Eigen::Vector4d bounded = rotation.coeffs() / rotation.coeffs().cwiseAbs().maxCoeff();
  stamped.world_T_camera.rotation.coeffs() = bounded.normalized();
  return stamped;
}

void appendNumber(std::string& text, double value) {
  std::array<char, 64> buffer{};
  const auto result =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value + 0.0, std::chars_format::general, 9);
  text += ' ';
  text.append(buffer.data(), result.ptr);
}

}  // namespace

Trajectory readTrajectory(const std::string& path) {
  Trajectory trajectory;
  for (const TextLine& line : readTextLines(path)) trajectory.push_back(parsePose(path, line));
  if (trajectory.empty()) {
    throw InputError(path + ": holds no poses; expected lines 'time [s] tx ty tz qx qy qz qw'");
  }
  std::stable_sort(trajectory.begin(), trajectory.end(),
                   [](const StampedPose& a, const StampedPose& b) { return a.time_ns < b.time_ns; });
  return trajectory;
}

std::string formatTrajectory(const Trajectory& trajectory) {
  std::string text = "# timestamp tx ty tz qx qy qz qw\n";
  for (const StampedPose& stamped : trajectory) {
    text += formatStamp(stamped.time_ns);
    const Eigen::Vector3d& t = stamped.world_T_camera.translation;
    const Eigen::Quaterniond& q = stamped.world_T_camera.rotation;
    for (const double value : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) appendNumber(text, value);
    text += '\n';
  }
  return text;
}

}  // namespace edgeslam
