#include "mapping/loose_unit_check.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/angles.h"
#include "inertia/found_time_offset.h"
#include "inertia/samples_since.h"
#include "inertia/turn_fit.h"

namespace edgeslam {
namespace {

// In which a unit on rubber, or on a loose screw, swings back.
constexpr double turned_for_s = 0.2;
constexpr double least_looked_at_s = 5;
constexpr std::int64_t look_interval_ns = 1'000'000'000;
// So far a turn of the unit's is from the camera's: a degree tips gravity by 0.17 m/s^2, more than the bias of a unit
// that is in order; and more than a focal length that is wrong makes of it.
constexpr double least_angle = radians(1.0), least_share_of_turn = 0.3;
// By so much it turns further than the camera: where axes are swapped it turns as far, and where frames are posed
// wrongly it is the camera that does.
constexpr double least_further = radians(0.5);
constexpr double loose_share = 0.1;  // of the turns: frames that are posed wrongly are fewer

std::vector<PosedCamera> latest(const std::vector<PosedCamera>& frames) {
  const std::int64_t begin_ns = frames.back().time_ns - LooseUnitCheck::looked_back_ns;
  return {std::find_if(frames.begin(), frames.end(), [&](const PosedCamera& f) { return f.time_ns >= begin_ns; }),
          frames.end()};
}

// As well as any unit that sits firmly can explain the turns. Turns about one axis do not tell its rotation.
std::optional<TurnFit> bestFit(const std::vector<CameraTurn>& turns, const std::vector<InertialSample>& samples,
                               const InertialUnit& unit) {
  const double offset_s = 1e-9 * static_cast<double>(unit.offset_ns);
  const TurnParameters start{unit.imu_T_camera.rotation, Eigen::Vector3d::Zero(), offset_s};
  std::optional<TurnFit> fit = fitTurns(turns, samples, start, unit.rate_walk);
  if (!fit) fit = fitTurns(turns, samples, start, unit.rate_walk, /*rotation_is_known=*/true);
  const bool is_near =
      fit && std::abs(fit->parameters.offset_s - offset_s) < 1e-9 * static_cast<double>(farthest_time_offset_ns);
  return is_near ? fit : std::nullopt;
}

}  // namespace

bool LooseUnitCheck::look(const std::vector<PosedCamera>& frames, const std::vector<InertialSample>& samples,
                          const InertialUnit& unit) {
  if (isLoose()) return true;
  if (frames.empty() || frames.back().time_ns < looked_ns_ + look_interval_ns) return false;
  looked_ns_ = frames.back().time_ns;
  const std::vector<CameraTurn> turns = cameraTurns(latest(frames), turned_for_s);
  if (turns.size() < fewest_turns || samples.empty()) return false;
  const std::int64_t begin_ns = turns.front().from_ns + unit.offset_ns - 2 * farthest_time_offset_ns;
  const std::vector<InertialSample> beside = samplesSince(samples, begin_ns);
  const std::optional<TurnFit> fit = bestFit(turns, beside, unit);
  if (!fit || fit->seconds < least_looked_at_s) return false;
  // A bias that was fitted to what cannot be explained is none.
  const GyroscopeTurns gyroscope(beside, fit->parameters.rate_bias), as_measured(beside, Eigen::Vector3d::Zero());
  const std::int64_t offset_ns = std::llround(1e9 * fit->parameters.offset_s);
  std::size_t loose = 0, compared = 0;
  largest_ = 0;
  for (const CameraTurn& seen : turns) {
    const auto felt = gyroscope.between(seen.from_ns + offset_ns, seen.to_ns + offset_ns);
    if (!felt) continue;
    ++compared;
    const double error = turnError(fit->parameters, seen, *felt).error.norm();
    const double angle =
        rotationLog(as_measured.between(seen.from_ns + offset_ns, seen.to_ns + offset_ns)->rotation).norm();
    const bool is_far = error > std::max(least_angle, least_share_of_turn * angle);
    if (!is_far || angle < rotationLog(seen.rotation).norm() + least_further) continue;
    ++loose;
    largest_ = std::max(largest_, error);
  }
  share_ = static_cast<double>(loose) / static_cast<double>(compared);
  loose_looks_ = share_ > loose_share ? loose_looks_ + 1 : 0;
  return isLoose();
}

}  // namespace edgeslam
