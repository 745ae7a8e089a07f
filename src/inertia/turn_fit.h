// How an inertial unit sits on a camera, how their clocks differ and what the gyroscope's bias is, by least squares
// over the turns that both measured; and how well this is known.
#pragma once

#include <optional>
#include <vector>

#include "inertia/camera_turns.h"
#include "inertia/gyroscope_turns.h"

namespace edgeslam {

// Small changes of it (7) are [rotation vector on the right of imu_R_camera [rad]; rate_bias [rad/s]; offset_s [s]].
struct TurnParameters {
  Eigen::Quaterniond imu_R_camera = Eigen::Quaterniond::Identity();
  Eigen::Vector3d rate_bias = Eigen::Vector3d::Zero();  // the unit's frame [rad/s]
  double offset_s = 0;                                  // as InertialUnit::offset_ns
};

using Vector7d = Eigen::Matrix<double, 7, 1>;
using Matrix7d = Eigen::Matrix<double, 7, 7>;
using Matrix37d = Eigen::Matrix<double, 3, 7>;

constexpr std::size_t fewest_turns = 60;

TurnParameters changed(const TurnParameters& parameters, const Vector7d& change);

// How far the camera's turn differs from the gyroscope's [rad], and its derivative by a change of the parameters.
struct TurnError {
  Eigen::Vector3d error;
  Matrix37d by_parameters;
};

// `felt`: by the gyroscope over the time of `seen`, with the bias and the offset of `parameters`.
TurnError turnError(const TurnParameters& parameters, const CameraTurn& seen, const GyroscopeTurn& felt);

struct TurnFit {
  TurnParameters parameters;
  Matrix7d covariance = Matrix7d::Zero();  // of a small change
  std::size_t turns = 0;                   // that both measured
  double seconds = 0;                      // in which they lie
  double error_rad = 0;                    // rms of a turn's error, each axis
};

// From `start` on, which is near. Errors of a camera's poses hang together over a while, so that parts of the recording
// and not turns are what is independent: the scatter of what each part adds gives the covariance, and the walk of the
// bias, `rate_walk` [rad/s^2/sqrt(Hz)], adds to it. None where too few turns were measured by both, or they do not tell
// all parameters. A rotation that is known stays as it is.
std::optional<TurnFit> fitTurns(const std::vector<CameraTurn>& turns, const std::vector<InertialSample>& samples,
                                const TurnParameters& start, double rate_walk, bool rotation_is_known = false);

}  // namespace edgeslam
