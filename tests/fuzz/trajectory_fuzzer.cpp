// Trajectories, and what `edgeslam evaluate` makes of two of them: finite figures, or one message. Estimate and
// reference are parted by a line "====".
#include <algorithm>
#include <cmath>

#include "edgeslam/input_error.h"
#include "evaluation/evaluation.h"
#include "evaluation/trajectory.h"
#include "fuzz_input.h"

namespace {

using namespace edgeslam;

constexpr std::size_t most_poses = 2000;  // beyond it an input is only slow

Trajectory readChecked(const std::string& path) {
  const Trajectory trajectory = readTrajectory(path);
  require(!trajectory.empty(), "a trajectory has poses");
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const Pose& pose = trajectory[i].world_T_camera;
    require(pose.translation.allFinite(), "positions are finite");
    require(std::abs(pose.rotation.norm() - 1) < 1e-6, "rotations are unit quaternions");
    require(i == 0 || trajectory[i - 1].time_ns <= trajectory[i].time_ns, "time stamps are in order");
  }
  return trajectory;
}

// Time stamps are kept, values to 9 digits.
void requireReadBack(const Trajectory& trajectory, const MemoryFolder& folder) {
  const Trajectory again = readTrajectory(folder.write("written.txt", formatTrajectory(trajectory)));
  require(again.size() == trajectory.size(), "as many poses are read back");
  for (std::size_t i = 0; i < again.size(); ++i) {
    const Pose &read = again[i].world_T_camera, &written = trajectory[i].world_T_camera;
    require(again[i].time_ns == trajectory[i].time_ns, "time stamps are read back");
    const Eigen::Vector3d size = written.translation.cwiseAbs(), off = (read.translation - written.translation);
    require((off.array().abs() <= 1e-8 * size.array() + 1e-300).all(), "positions are read back");
    require(read.rotation.angularDistance(written.rotation) < 1e-6, "rotations are read back");
  }
}

bool isFinite(const ErrorStatistics& values) {
  return std::isfinite(values.rmse + values.mean + values.median + values.standard_deviation + values.min + values.max);
}

void evaluate(const Trajectory& estimate, const Trajectory& reference, Alignment alignment) {
  try {
    const AbsoluteError absolute = absoluteError(estimate, reference, alignment);
    require(isFinite(absolute.translation), "absolute errors are finite");
    require(std::isfinite(absolute.reference_T_estimate.scale), "the scale is finite");
    const RelativeError relative = relativeError(estimate, reference, alignment);
    require(isFinite(relative.translation) && isFinite(relative.rotation), "relative errors are finite");
  } catch (const InputError& error) {
    requireMessage(error.what(), "");
  }
  const Coverage covered = coverage(estimate, reference);
  for (const double share : {covered.time_share, covered.pose_share, covered.pose_share_after_start}) {
    require(share >= 0 && share <= 1 + 1e-9, "shares are 0 to 1");
  }
  require(std::isfinite(covered.start_s), "the start is finite");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const MemoryFolder folder;
  const auto files = splitFiles(data, size, 2);
  const std::string path = folder.write("estimate.txt", files[0]);
  std::string read = path;
  try {
    const Trajectory estimate = readChecked(path);
    requireReadBack(estimate, folder);
    read = folder.write("reference.txt", files[1]);
    const Trajectory reference = readChecked(read);
    if (estimate.size() + reference.size() > most_poses) return 0;
    for (const Alignment alignment : {Alignment::similarity, Alignment::rigid, Alignment::none}) {
      evaluate(estimate, reference, alignment);
    }
  } catch (const InputError& error) {
    requireMessage(error.what(), read);
  }
  return 0;
}
