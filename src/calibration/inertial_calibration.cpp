#include "calibration/inertial_calibration.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "calibration/turn_alignment.h"
#include "files/format_text.h"
#include "geometry/angles.h"

namespace edgeslam {
namespace {

// Long against the errors of single poses, short against the time in which a hand turns to and fro.
constexpr double turn_s = 0.2;
constexpr double shortest_s = 8;               // of turns that both measured
constexpr double least_rate = 0.02;            // rms about an axis [rad/s]: else nothing turned about it
constexpr double least_over_difference = 2.5;  // the same, as a multiple of the difference about an axis
constexpr double largest_difference = 0.5;     // as a share of the rates
constexpr double mirrored_gain = 2;            // by which a mirror's axes must fit better to be told
constexpr double largest_rotation_sigma = radians(0.5);
constexpr double largest_offset_sigma_s = 0.005;

// A direction in the camera's frame as people speak of it.
std::string axisText(const Eigen::Vector3d& axis) {
  constexpr double near = 0.9;  // cosine
  constexpr std::array<const char*, 3> names{"x axis (nodding)", "y axis (turning left and right)",
                                             "z axis (rolling about the direction of view)"};
  for (int i = 0; i < 3; ++i) {
    if (std::abs(axis(i)) > near) return std::string("its ") + names[static_cast<std::size_t>(i)];
  }
  return formatted("the axis %.2f %.2f %.2f of its frame", axis.x(), axis.y(), axis.z());
}

double leastDifference(const TurnAlignment& alignment) {
  return std::min(alignment.difference, alignment.mirrored_difference);
}

bool hasTurnedAbout(const TurnAlignment& alignment, int axis) {
  const double about_an_axis = leastDifference(alignment) / std::sqrt(3.0);
  return alignment.common_rates(axis) > std::max(least_rate, least_over_difference * about_an_axis);
}

std::string degreesASecond(double rate) { return formatted("%.1f degrees/s", degrees(rate)); }

// Why the rates of camera and gyroscope do not tell how these sit to each other; empty where they do.
std::string motionProblem(const TurnAlignment& alignment) {
  if (alignment.turns < fewest_turns) {
    return "camera and inertial unit have too little time in common: do their time stamps belong together?";
  }
  const double common = alignment.common_rates.norm();
  if (alignment.common_rates(0) < least_rate) {
    return "the camera hardly turns (by " + degreesASecond(common) +
           " that both measured): turn it to and fro about all three of its axes";
  }
  if (leastDifference(alignment) > largest_difference * common) {
    return "the gyroscope contradicts the camera's turns, however it sits and for any offset of the clocks up to " +
           formatted("%.1f s: is it the unit on this camera?", longest_offset_tried_s);
  }
  if (alignment.is_at_end) {
    return formatted(
        "the clocks seem to differ by more than %.1f s: correct the time stamps, or give about what they "
        "differ by (time_offset_s)",
        longest_offset_tried_s);
  }
  if (hasTurnedAbout(alignment, 2) && alignment.difference > mirrored_gain * alignment.mirrored_difference) {
    return "the gyroscope's axes are a mirror image of right-handed ones: one sign is wrong, or two axes are swapped";
  }
  if (!hasTurnedAbout(alignment, 0)) {
    return "the camera's poses err too much to tell how it turns: it needs more texture, a better calibration of the "
           "camera, or faster turns";
  }
  if (!hasTurnedAbout(alignment, 1)) {
    return "the camera turns about one axis only, " + axisText(alignment.axes.col(0)) +
           ": how the unit is turned about that one stays unknown; turn it about the others, too";
  }
  return "";
}

std::string accuracyProblem(const TurnFit& fit) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread(fit.covariance.topLeftCorner<3, 3>());
  const double worst = std::sqrt(spread.eigenvalues()(2));
  if (worst > largest_rotation_sigma) {
    return formatted(
        "the rotation about %s is known to %.2f degrees only: turn the camera more about the others, before more "
        "texture",
        axisText(spread.eigenvectors().col(2)).c_str(), degrees(worst));
  }
  if (offsetSigma(fit) > largest_offset_sigma_s) {
    return formatted("the clocks' offset is known to %.1f ms only: turn the camera to and fro faster",
                     1e3 * offsetSigma(fit));
  }
  return "";
}

}  // namespace

InertialCalibration calibrateInertialUnit(const std::vector<PosedCamera>& poses,
                                          const std::vector<InertialSample>& samples, const InertialUnit& known) {
  InertialCalibration calibration;
  calibration.turn_s = turn_s;
  const std::vector<CameraTurn> turns = cameraTurns(poses, turn_s);
  const TurnAlignment rough = alignTurns(turns, samples, static_cast<double>(known.offset_ns) * 1e-9);
  calibration.problem = motionProblem(rough);
  if (!calibration.problem.empty()) return calibration;
  const std::optional<TurnFit> fit =
      fitTurns(turns, samples, {rough.imu_R_camera, rough.rate_bias, rough.offset_s}, known.rate_walk);
  if (!fit || fit->seconds < shortest_s) {
    calibration.problem = "camera and inertial unit have " +
                          (fit ? formatted("%.1f s", fit->seconds) : std::string("too little time")) +
                          formatted(" in common, %.0f s are needed", shortest_s);
    return calibration;
  }
  calibration.fit = *fit;
  calibration.forces = fitForces(poses, samples, unitWith(known, fit->parameters),
                                 fit->covariance.topLeftCorner<3, 3>(), fit->parameters.rate_bias);
  calibration.problem = accuracyProblem(*fit);
  if (!hasTurnedAbout(rough, 2)) {
    calibration.unchecked = "the camera hardly turns about " + axisText(rough.axes.col(2)) +
                            ": a wrong sign of one of the gyroscope's axes would not be noticed";
  }
  return calibration;
}

InertialUnit unitWith(const InertialUnit& known, const TurnParameters& found) {
  InertialUnit unit = known;
  unit.imu_T_camera.rotation = found.imu_R_camera;
  unit.offset_ns = std::llround(found.offset_s * 1e9);
  return unit;
}

Eigen::Vector3d rotationSigma(const TurnFit& fit) { return fit.covariance.diagonal().head<3>().cwiseSqrt(); }

Eigen::Vector3d biasSigma(const TurnFit& fit) { return fit.covariance.diagonal().segment<3>(3).cwiseSqrt(); }

double offsetSigma(const TurnFit& fit) { return std::sqrt(fit.covariance(6, 6)); }

}  // namespace edgeslam
