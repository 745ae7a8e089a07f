#include "scale/scale_from_distance.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "wheels/utime.h"

namespace edgeslam {

PositionHistory::PositionHistory(std::size_t capacity) : positions_(capacity) { assert(capacity > 0); }

void PositionHistory::add(const FrameResult& result) {
  const std::optional<MeasuredPose> measured = measuredPose(result);
  if (!measured) return;
  Position& position = positions_[next_];
  position.utime = utimeOf(measured->time_ns);
  position.world = measured->world;
  position.position = measured->world_T_camera.translation;
  const Eigen::Matrix3d world_R_camera = measured->world_T_camera.rotation.toRotationMatrix();
  position.covariance = world_R_camera * measured->covariance_camera.topLeftCorner<3, 3>() * world_R_camera.transpose();
  next_ = (next_ + 1) % positions_.size();
  count_ = std::min(count_ + 1, positions_.size());
}

const PositionHistory::Position* PositionHistory::find(std::int64_t utime) const {
  for (std::size_t back = 1; back <= count_; ++back) {
    const Position& position = positions_[(next_ + positions_.size() - back) % positions_.size()];
    if (position.utime == utime) return &position;
  }
  return nullptr;
}

ScaleResult scaleFromDistance(const PositionHistory& history, std::int64_t from_utime, std::int64_t to_utime,
                              double distance_m, const ScaleOptions& options) {
  const PositionHistory::Position *from = history.find(from_utime), *to = history.find(to_utime);
  if (!from || !to) {
    return {{},
            std::string(from ? "to_utime" : "from_utime") +
                " is the time stamp of no frame with a measured pose since the map was last corrected"};
  }
  if (from->world != to->world) return {{}, "the two frames are in maps that were not joined"};
  const Eigen::Vector3d way = to->position - from->position;
  const double distance = way.norm();
  if (!(distance > 0)) return {{}, "the camera did not move between the two frames"};
  const Eigen::Vector3d direction = way / distance;
  const double variance = direction.dot((from->covariance + to->covariance) * direction);
  const double sigma = std::sqrt(std::max(variance, 0.0)) / distance;
  if (!(sigma <= options.largest_sigma)) {
    return {{},
            "the two frames are too near together: their distance is known to " +
                std::to_string(std::lround(100 * std::min(sigma, 1e6))) + " % only"};
  }
  return {{ScaleKind::known_distance, distance_m / distance, sigma}, "", to->world};
}

}  // namespace edgeslam
