#include "tracking/map_confirmation.h"

namespace edgeslam {

void MapConfirmation::observe(const PointsConfirmed& points, const ConfirmedPose& pose) {
  points_ = points;
  const bool says_something = points.expected >= options_.fewest_expected;
  const bool is_suspect = before_doubt_ || is_unproven_;
  const double least = is_suspect ? options_.least_share_to_believe_again : options_.least_share;
  const bool contradicts = says_something ? points.confirmed < least * points.expected : before_doubt_.has_value();
  if (says_something && !contradicts) is_unproven_ = false;
  if (!contradicts) confirmed_ = pose;
  before_doubt_ = contradicts ? confirmed_ : std::nullopt;
}

void MapConfirmation::move(const Similarity& new_world_S_old) {
  for (std::optional<ConfirmedPose>* pose : {&confirmed_, &before_doubt_}) {
    if (*pose) (*pose)->world_T_camera = moved(new_world_S_old, (*pose)->world_T_camera);
  }
}

void MapConfirmation::forget() {
  points_ = {};
  is_unproven_ = false;
  confirmed_.reset();
  before_doubt_.reset();
}

double MapConfirmation::positionVariance(const Pose& world_T_camera) const {
  if (!before_doubt_) return 0;
  return (world_T_camera.translation - before_doubt_->world_T_camera.translation).squaredNorm();
}

}  // namespace edgeslam
