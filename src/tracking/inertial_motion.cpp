#include "tracking/inertial_motion.h"

#include <cmath>

#include "geometry/squared.h"
#include "inertia/found_time_offset.h"

namespace edgeslam {
namespace {

constexpr double longest_for_speed_s = 0.35, shortest_for_speed_s = 0.05;
// What is known no better, whatever the covariances say: gravity against the camera, and how units err beyond noise.
constexpr double tilt_sigma = 3e-3;         // [rad]
constexpr double least_speed_sigma = 0.01;  // [m/s]

// Of too many the older half goes.
template <typename Value>
void keep(const Value& value, std::size_t most, std::vector<Value>& values) {
  if (values.size() == most) values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(most / 2));
  values.push_back(value);
}

double secondsBetween(std::int64_t from_ns, std::int64_t to_ns) { return static_cast<double>(to_ns - from_ns) * 1e-9; }

}  // namespace

PosePrior priorOf(const InertialPrediction& prediction) {
  if (!prediction.knows_position) return {};
  return {prediction.world_T_camera, prediction.covariance.inverse()};
}

InertialMotion::InertialMotion(const std::optional<InertialUnit>& unit) {
  if (!unit) return;
  history_.emplace(*unit);
  camera_T_imu_ = unit->imu_T_camera.inverse();
  felt_.reserve(most_felt);
  turns_.reserve(most_turns);
}

void InertialMotion::add(const InertialSample& sample) {
  if (isThere() && history_->add(sample)) keep(sample, most_felt, felt_);
}

void InertialMotion::observeTurn(const CameraTurn& turn) {
  if (isThere() && turn.rotation.coeffs().allFinite()) keep(turn, most_turns, turns_);
}

void InertialMotion::tell(TrackedFrame& keyframe) {
  std::swap(keyframe.felt, felt_);
  std::swap(keyframe.turns, turns_);
  felt_.clear();
  turns_.clear();
}

void InertialMotion::setOffset(std::int64_t offset_ns) {
  if (isThere()) history_->setOffset(offset_ns);
}

void InertialMotion::setRotation(const Eigen::Quaterniond& imu_R_camera) {
  if (!isThere()) return;
  Pose imu_T_camera = history_->unit().imu_T_camera;
  imu_T_camera.rotation = imu_R_camera;
  camera_T_imu_ = imu_T_camera.inverse();
}

void InertialMotion::observe(const TimedCamera& last, const TimedCamera& camera, double sigma) {
  if (isThere()) located_.add(last, {camera, sigma});
}

// Of the unit [m].
Eigen::Vector3d InertialMotion::place(const Pose& world_T_camera, double metres_a_unit) const {
  return metres_a_unit * world_T_camera.translation + world_T_camera.rotation * camera_T_imu_.translation;
}

// From a frame some tenths of a second ago: the way from there, less what was felt on it.
std::optional<InertialMotion::Speed> InertialMotion::speedAt(const TimedCamera& last,
                                                             const InertialAlignment& alignment) const {
  if (located_.size() == 0) return std::nullopt;
  const Located& latest = located_.before(0);
  if (latest.camera.time_ns != last.time_ns) return std::nullopt;
  const Located* before = nullptr;
  for (std::size_t back = 1; back < located_.size(); ++back) {
    const Located& located = located_.before(back);
    if (secondsBetween(located.camera.time_ns, last.time_ns) > longest_for_speed_s) break;
    before = &located;
  }
  const double seconds = before ? secondsBetween(before->camera.time_ns, last.time_ns) : 0;
  if (seconds < shortest_for_speed_s) return std::nullopt;
  const auto motion = history_->between(before->camera.time_ns, last.time_ns, alignment.bias);
  if (!motion) return std::nullopt;
  // The map may have been adjusted since: what was seen then moves along with the last frame.
  const Pose then = last.world_T_camera * latest.camera.world_T_camera.inverse() * before->camera.world_T_camera;
  const Eigen::Quaterniond rotation = then.rotation * camera_T_imu_.rotation;
  const Eigen::Vector3d way =
      place(last.world_T_camera, alignment.metres_a_unit) - place(then, alignment.metres_a_unit);
  const Eigen::Vector3d velocity_then =
      (way - rotation * motion->position) / seconds - 0.5 * seconds * alignment.gravity;
  Speed speed;
  speed.velocity = velocity_then + seconds * alignment.gravity + rotation * motion->velocity;
  speed.sigma =
      std::sqrt(squared(alignment.metres_a_unit) * (squared(before->sigma) + squared(latest.sigma)) / squared(seconds) +
                squared(0.5 * seconds * alignment.force_bias_sigma) +
                squared(0.5 * seconds * tilt_sigma * standard_gravity) + squared(least_speed_sigma));
  return speed;
}

std::optional<InertialPrediction> InertialMotion::predict(const TimedCamera& last, const Matrix6d& covariance,
                                                          std::int64_t time_ns,
                                                          const std::optional<InertialAlignment>& alignment,
                                                          const InertialPrediction& by_camera) const {
  if (!isThere()) return std::nullopt;
  const InertialAlignment known = alignment.value_or(InertialAlignment{});
  const auto motion = history_->between(last.time_ns, time_ns, known.bias);
  if (!motion) return std::nullopt;
  const Eigen::Quaterniond world_R_imu = last.world_T_camera.rotation * camera_T_imu_.rotation;
  InertialPrediction prediction = by_camera;
  prediction.world_T_camera.rotation =
      (world_R_imu * motion->rotation * camera_T_imu_.rotation.conjugate()).normalized();
  const double seconds = motion->seconds;
  prediction.covariance.bottomRightCorner<3, 3>() = covariance.bottomRightCorner<3, 3>();
  prediction.covariance.diagonal().tail<3>().array() +=
      motion->covariance.topLeftCorner<3, 3>().trace() / 3 + squared(known.rate_bias_sigma * seconds);
  const std::optional<Speed> speed = known.is_known ? speedAt(last, known) : std::nullopt;
  if (!speed) return prediction;
  const Eigen::Vector3d now = place(last.world_T_camera, known.metres_a_unit) + seconds * speed->velocity +
                              0.5 * seconds * seconds * known.gravity + world_R_imu * motion->position;
  prediction.world_T_camera.translation =
      (now - prediction.world_T_camera.rotation * camera_T_imu_.translation) / known.metres_a_unit;
  const double variance =
      squared(speed->sigma * seconds) +
      squared(0.5 * seconds * seconds) * (squared(known.force_bias_sigma) + squared(tilt_sigma * standard_gravity)) +
      motion->covariance.bottomRightCorner<3, 3>().trace() / 3;
  prediction.covariance.topLeftCorner<3, 3>() = covariance.topLeftCorner<3, 3>();
  prediction.covariance.diagonal().head<3>().array() += variance / squared(known.metres_a_unit);
  prediction.covariance.topRightCorner<3, 3>().setZero();
  prediction.covariance.bottomLeftCorner<3, 3>().setZero();
  prediction.knows_position = true;
  return prediction;
}

std::optional<InertialTurn> InertialMotion::turnBetween(std::int64_t from_ns, std::int64_t to_ns,
                                                        const std::optional<InertialAlignment>& alignment) const {
  if (!isThere()) return std::nullopt;
  const InertialAlignment known = alignment.value_or(InertialAlignment{});
  const std::optional<Eigen::Quaterniond> turn = history_->turnBetween(from_ns, to_ns, known.bias);
  if (!turn) return std::nullopt;
  const double seconds = secondsBetween(from_ns, to_ns);
  return InertialTurn{(camera_T_imu_.rotation * *turn * camera_T_imu_.rotation.conjugate()).normalized(),
                      squared(history_->unit().rate_noise) * seconds + squared(known.rate_bias_sigma * seconds)};
}

InertialLink InertialMotion::linkUpTo(std::int64_t time_ns, const std::optional<InertialAlignment>& alignment) const {
  if (!isThere() || last_keyframe_ < 0) return {};
  const auto motion = history_->between(keyframe_ns_, time_ns, alignment ? alignment->bias : InertialBias{});
  return motion ? InertialLink{last_keyframe_, *motion, history_->unit().offset_ns} : InertialLink{};
}

InertialLink InertialMotion::linkTo(KeyframeId keyframe, std::int64_t time_ns,
                                    const std::optional<InertialAlignment>& alignment) {
  const InertialLink link = linkUpTo(time_ns, alignment);
  linkFrom(keyframe, time_ns);
  return link;
}

void InertialMotion::beginStart(KeyframeId first, std::int64_t time_ns) {
  since_start_ = {first, PreintegratedMotion(), history_ ? history_->unit().offset_ns : 0};
  start_ns_ = time_ns;
}

InertialLink InertialMotion::linkSinceStart(std::int64_t time_ns) {
  if (!isThere() || since_start_.from < 0) return {};
  const auto motion = history_->between(start_ns_, time_ns, InertialBias{});
  if (motion) {
    since_start_.motion = joined(since_start_.motion, *motion);
    start_ns_ = time_ns;
  } else {
    since_start_.from = -1;
  }
  return since_start_;
}

void InertialMotion::linkFrom(KeyframeId keyframe, std::int64_t time_ns) {
  last_keyframe_ = keyframe;
  keyframe_ns_ = time_ns;
}

}  // namespace edgeslam
