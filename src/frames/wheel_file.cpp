#include "frames/wheel_file.h"

#include <array>
#include <cmath>
#include <optional>

#include "edgeslam/input_error.h"
#include "files/text_file.h"
#include "wheels/utime.h"

namespace edgeslam {
namespace {

constexpr double farthest_m = 1e6;

struct Parsed {
  OdometryPose pose;
  std::string problem;  // else it is one
};

Parsed parse(const std::string& text) {
  const std::string expected =
      "expected 8 columns (time [s], position x y z [m], quaternion x y z w), found '" + text + "'";
  const std::vector<std::string_view> columns = splitColumns(text);
  const std::optional<std::int64_t> time = columns.size() == 8 ? parseStamp(columns[0]) : std::nullopt;
  if (!time) return {{}, expected};
  std::array<double, 7> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::optional<double> value = parseNumber(columns[i + 1]);
    if (!value) return {{}, expected};
    values[i] = *value;
  }
  const Eigen::Vector3d position(values[0], values[1], values[2]);
  if (position.cwiseAbs().maxCoeff() > farthest_m) return {{}, "the position is over 1000 km from the start"};
  const Eigen::Quaterniond rotation(values[6], values[3], values[4], values[5]);
  if (!(std::abs(rotation.norm() - 1) <= 0.01)) return {{}, "the quaternion (x y z w) must have the length 1"};
  return {{utimeOf(*time), {rotation.normalized(), position}}, ""};
}

}  // namespace

std::vector<OdometryPose> readWheelOdometry(const std::string& path) {
  std::vector<OdometryPose> poses;
  for (const TextLine& line : readTextLines(path)) {
    const Parsed parsed = parse(line.text);
    if (!parsed.problem.empty()) {
      if (!line.ended && !poses.empty()) break;
      throw InputError(placeInFile(path, line.number) + parsed.problem);
    }
    if (!poses.empty() && parsed.pose.utime <= poses.back().utime) {
      throw InputError(placeInFile(path, line.number) + "the time stamp is not after the one before");
    }
    poses.push_back(parsed.pose);
  }
  if (poses.empty()) throw InputError(path + ": holds no poses");
  return poses;
}

}  // namespace edgeslam
