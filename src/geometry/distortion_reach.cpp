#include "geometry/distortion_reach.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geometry/millionths.h"

namespace edgeslam {
namespace {

std::size_t radialCount(const Camera& camera) { return camera.model == CameraModel::kannala_brandt ? 4 : 3; }

// Of a radial coefficient in Camera::distortion, where the tangential ones stand between those of a pinhole camera.
std::size_t indexOfRadial(const Camera& camera, std::size_t i) {
  return camera.model == CameraModel::kannala_brandt || i < 2 ? i : 4;
}

std::array<double, 4> radialCoefficients(const Camera& camera) {
  std::array<double, 4> k{};
  for (std::size_t i = 0; i < radialCount(camera); ++i) k[i] = camera.distortion[indexOfRadial(camera, i)];
  return k;
}

double distortedAt(const std::array<double, 4>& k, double r) {
  const double r2 = r * r;
  return r * (1 + r2 * (k[0] + r2 * (k[1] + r2 * (k[2] + r2 * k[3]))));
}

double slopeAt(const std::array<double, 4>& k, double r) {
  const double r2 = r * r;
  return 1 + r2 * (3 * k[0] + r2 * (5 * k[1] + r2 * (7 * k[2] + r2 * 9 * k[3])));
}

// The first `kept` radial coefficients, fitted to all of them up to the distance `farthest` from the axis; the others
// 0. Each part of the image counts by its area.
Camera withFewerCoefficients(Camera camera, double farthest, std::size_t kept) {
  constexpr int samples = 256;
  const std::array<double, 4> k = radialCoefficients(camera);
  const auto size = static_cast<Eigen::Index>(kept);
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(size), powers(size);
  for (int i = 1; i <= samples; ++i) {
    const double r = farthest * i / samples;
    double power = r;
    for (Eigen::Index n = 0; n < size; ++n) powers(n) = power *= r * r;
    information += r * powers * powers.transpose();
    gradient += r * powers * (distortedAt(k, r) - r);
  }
  const Eigen::VectorXd fitted = information.ldlt().solve(gradient);
  for (std::size_t i = 0; i < radialCount(camera); ++i) {
    camera.distortion[indexOfRadial(camera, i)] = i < kept ? inMillionths(fitted(static_cast<Eigen::Index>(i))) : 0;
  }
  return camera;
}

}  // namespace

double farthestCorner(const Camera& camera) {
  const double x = std::max(camera.cx, camera.width - 1 - camera.cx) / camera.fx;
  const double y = std::max(camera.cy, camera.height - 1 - camera.cy) / camera.fy;
  return std::hypot(x, y);
}

double distortionReach(const Camera& camera) {
  constexpr double least_slope = 0.5;  // by the angle from the axis; it is 1 in the centre
  constexpr double step = 0.01, close_enough = 1e-7;
  const bool is_fisheye = camera.model == CameraModel::kannala_brandt;
  const double farthest = is_fisheye ? 3.15 : 12;  // 180 and 85 degrees from the axis
  const std::array<double, 4> k = radialCoefficients(camera);
  const auto isBelieved = [&](double r) {
    const double tangent_by_angle = is_fisheye ? 1 : 1 + r * r;
    return slopeAt(k, r) * tangent_by_angle >= least_slope;
  };
  for (double beyond = step; beyond < farthest; beyond += step) {
    if (isBelieved(beyond)) continue;
    double believed = beyond - step;
    while (beyond - believed > close_enough) {
      const double middle = 0.5 * (believed + beyond);
      (isBelieved(middle) ? believed : beyond) = middle;
    }
    return believed;
  }
  return std::numeric_limits<double>::infinity();
}

double seenAtReach(const Camera& camera) {
  const double reach = distortionReach(camera);
  return std::isfinite(reach) ? distortedAt(radialCoefficients(camera), reach) : reach;
}

bool reachesCorners(const Camera& camera) { return seenAtReach(camera) > farthestCorner(camera); }

Camera withBelievableDistortion(const Camera& camera) {
  if (reachesCorners(camera)) return camera;
  constexpr double share_to_fit = 0.85;  // of the reach: on the way to where it turns back it errs already
  const double farthest = share_to_fit * distortionReach(camera);
  for (std::size_t kept = radialCount(camera) - 1; kept > 0; --kept) {
    const Camera simpler = withFewerCoefficients(camera, farthest, kept);
    if (reachesCorners(simpler)) return simpler;
  }
  return camera;
}

DistortionTangent distortionTangent(const Camera& camera) {
  const double reach = camera.distortion_reach;
  if (!std::isfinite(reach)) return {};
  const std::array<double, 4> k = radialCoefficients(camera);
  const double slope = slopeAt(k, reach);
  return {distortedAt(k, reach) - slope * reach, slope};
}

}  // namespace edgeslam
