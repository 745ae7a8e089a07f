// How an inertial unit turned between any two times of a recording, by its gyroscope alone, with what it takes to
// change bias and times.
#pragma once

#include <optional>
#include <vector>

#include "inertia/inertial_unit.h"

namespace edgeslam {

struct GyroscopeTurn {
  Eigen::Quaterniond rotation;         // the unit's frame at the first time, R at the second
  Eigen::Matrix3d by_bias;             // derivative of its error, a rotation vector on its right, by the bias [s]
  Eigen::Vector3d from_rate, to_rate;  // at both times, without the bias, the unit's frame [rad/s]
};

class GyroscopeTurns {
 public:
  // `samples` must outlive it; their times ascend. `rate_bias` [rad/s] is taken off.
  GyroscopeTurns(const std::vector<InertialSample>& samples, const Eigen::Vector3d& rate_bias);

  // Of the unit's clock. None where samples are missing: before the first, after the last, or over a gap in between.
  std::optional<GyroscopeTurn> between(std::int64_t from_ns, std::int64_t to_ns) const;

 private:
  // Since the first sample.
  struct Turned {
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
    Eigen::Matrix3d by_bias = Eigen::Matrix3d::Zero();
    std::size_t gaps = 0;
  };
  struct TurnedAt {
    Turned turned;
    Eigen::Vector3d rate;  // [rad/s]
  };

  Turned after(const Turned& before, const InertialSample& from, const InertialSample& to) const;
  std::optional<TurnedAt> at(std::int64_t time_ns) const;

  const std::vector<InertialSample>& samples_;
  Eigen::Vector3d rate_bias_;
  std::vector<Turned> until_;  // each sample
};

}  // namespace edgeslam
