#include "geometry/triangulation.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace edgeslam {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int start_samples = 16;              // depths tried for a start
constexpr double largest_parallax = M_PI / 3;  // of the nearest depth tried [rad]
constexpr double huber_error = 3.0;  // whitened error beyond which a view counts linearly in the choice of the start

// One view's whitened residual and its derivative by the inverse depth.
struct Residual {
  Eigen::Vector2d error;
  Eigen::Vector2d derivative;
};

// A fisheye sees beyond 90 degrees.
bool isAhead(const Camera& camera, const Eigen::Vector3d& point) {
  const double least_cosine = camera.model == CameraModel::kannala_brandt ? -0.5 : 0.02;
  return point.z() > least_cosine * point.norm();
}

// A distortion folds back far outside the image, where its derivative (symmetric but for fx and fy) is no longer
// positive definite: the tangential one, and the radial one of a camera without its distortion's reach.
bool isFolded(const Camera& camera, const Eigen::Matrix<double, 2, 3>& jacobian) {
  if (camera.model == CameraModel::kannala_brandt) return false;
  return jacobian(0, 0) <= 0 || jacobian(0, 0) * jacobian(1, 1) <= jacobian(0, 1) * jacobian(1, 0);
}

// False where the view can't see the point.
bool evaluate(const Camera& camera, const Eigen::Vector3d& host_bearing, const TriangulationView& view,
              double inverse_depth, Residual* residual) {
  const Eigen::Vector3d point = view.view_T_host.rotation * host_bearing + inverse_depth * view.view_T_host.translation;
  if (!isAhead(camera, point)) return false;
  Eigen::Matrix<double, 2, 3> jacobian;
  const Eigen::Vector2d pixel = project(camera, point, &jacobian);
  if (isFolded(camera, jacobian)) return false;
  const Eigen::Matrix2d whiten = whitening(view.measurement);
  residual->error = whiten * (pixel - view.measurement.pixel);
  residual->derivative = whiten * (jacobian * view.view_T_host.translation);
  return true;
}

// Sum over the views at one inverse depth; the cost is infinite where a view can't see the point.
struct NormalEquation {
  double cost = 0;         // sum of squared errors
  double robust_cost = 0;  // the same with Huber's loss
  double gradient = 0;     // J^T r
  double information = 0;  // J^T J
  double largest_error = 0;
};

NormalEquation accumulate(const Camera& camera, const Eigen::Vector3d& host_bearing,
                          const std::vector<TriangulationView>& views, double inverse_depth) {
  NormalEquation sum;
  for (const TriangulationView& view : views) {
    Residual residual;
    if (!evaluate(camera, host_bearing, view, inverse_depth, &residual)) {
      sum.cost = sum.robust_cost = sum.largest_error = infinity;
      return sum;
    }
    const double squared = residual.error.squaredNorm(), error = std::sqrt(squared);
    sum.cost += squared;
    sum.robust_cost += error < huber_error ? squared : huber_error * (2 * error - huber_error);
    sum.gradient += residual.derivative.dot(residual.error);
    sum.information += residual.derivative.squaredNorm();
    sum.largest_error = std::max(sum.largest_error, error);
  }
  return sum;
}

// The best of a few inverse depths, spread so that the parallax towards the view with the widest baseline (seen across
// the bearing) is covered from 0 to 60 degrees, more densely where it is small. Negative where none is visible.
double bestStart(const Camera& camera, const Eigen::Vector3d& host_bearing,
                 const std::vector<TriangulationView>& views) {
  double baseline = 0, widest = 0, angle = 0;  // angle at the host between the bearing and the baseline
  for (const TriangulationView& view : views) {
    const Eigen::Vector3d centre = -(view.view_T_host.rotation.conjugate() * view.view_T_host.translation);
    const double across = host_bearing.cross(centre).norm();
    if (!(across > widest)) continue;
    widest = across;
    baseline = centre.norm();
    angle = std::atan2(across, host_bearing.dot(centre));
  }
  if (!(widest > 0)) return -1;
  double best = -1, best_cost = infinity;
  for (int i = 0; i < start_samples; ++i) {
    const double share = static_cast<double>(i) / (start_samples - 1);
    const double parallax = share * share * std::min(largest_parallax, 0.95 * (M_PI - angle));
    const double inverse_depth = std::sin(parallax) / (baseline * std::sin(angle + parallax));  // law of sines
    const double cost = accumulate(camera, host_bearing, views, inverse_depth).robust_cost;
    if (!(cost < best_cost)) continue;
    best_cost = cost;
    best = inverse_depth;
  }
  return best;
}

double largestParallax(const Eigen::Vector3d& host_bearing, const std::vector<TriangulationView>& views,
                       double inverse_depth) {
  double largest = 0;
  for (const TriangulationView& view : views) {
    const Eigen::Vector3d from_host = view.view_T_host.rotation * host_bearing;
    const Eigen::Vector3d from_view = from_host + inverse_depth * view.view_T_host.translation;
    largest = std::max(largest, std::atan2(from_host.cross(from_view).norm(), from_host.dot(from_view)));
  }
  return largest;
}

}  // namespace

TriangulationResult triangulate(const Camera& camera, const Eigen::Vector3d& host_bearing,
                                const std::vector<TriangulationView>& views, double initial_inverse_depth) {
  TriangulationResult result;
  result.sigma = result.largest_error = infinity;
  double inverse_depth = initial_inverse_depth > 0 ? initial_inverse_depth : bestStart(camera, host_bearing, views);
  if (!(inverse_depth >= 0) || !std::isfinite(inverse_depth)) return result;
  NormalEquation at = accumulate(camera, host_bearing, views, inverse_depth);
  if (!std::isfinite(at.cost)) return result;

  bool at_minimum = false;
  for (int iteration = 0; iteration < 20 && !at_minimum && at.information > 0; ++iteration) {
    double step = -at.gradient / at.information;
    bool lower = false;
    for (int halving = 0; halving < 10; ++halving, step *= 0.5) {
      at_minimum = std::abs(step) * std::sqrt(at.information) < 1e-6;  // a step far below the standard deviation
      if (at_minimum) break;
      const double next = std::max(0.0, inverse_depth + step);
      const NormalEquation at_next = accumulate(camera, host_bearing, views, next);
      if (!(at_next.cost < at.cost)) continue;
      inverse_depth = next;
      at = at_next;
      lower = true;
      break;
    }
    if (!lower) break;
  }

  result.inverse_depth = inverse_depth;
  result.sigma = at.information > 0 ? 1.0 / std::sqrt(at.information) : infinity;
  result.parallax = largestParallax(host_bearing, views, inverse_depth);
  result.largest_error = at.largest_error;
  result.converged = at_minimum && inverse_depth > 0;
  return result;
}

}  // namespace edgeslam
