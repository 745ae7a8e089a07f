#include "scale/ground_plane.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <set>
#include <utility>

#include "geometry/angles.h"

namespace edgeslam {
namespace {

constexpr int samples = 3000;
constexpr int most_planes = 5;                 // one below the other
constexpr double inlier_sigmas = 2.5;          // a point on the plane is within so many standard deviations
constexpr double surface_sigma = 0.01;         // least standard deviation of a point, as a share of the height
constexpr double widest_inlier = 0.06;         // on the plane at most so far from it, as a share of the height
constexpr double clearly_below = 0.08;         // below the plane: farther than this, as a share of the height
constexpr double most_below = 0.03;            // so many below, as a share of those on the plane
constexpr double farthest = 8;                 // a point on the ground counts within so many heights
constexpr double least_extent = 0.2;           // standard deviation of its points along and across, in heights
constexpr double largest_height_spread = 0.1;  // of the cameras' heights, as a share

struct Plane {
  Eigen::Vector3d normal;
  double offset = 0;
};

double heightOver(const Plane& plane, const Eigen::Vector3d& point) { return plane.normal.dot(point) - plane.offset; }

Eigen::Vector3d meanOf(const std::vector<Eigen::Vector3d>& places) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& place : places) sum += place;
  return sum / static_cast<double>(places.size());
}

double meanHeight(const Plane& plane, const std::vector<Eigen::Vector3d>& cameras) {
  return heightOver(plane, meanOf(cameras));
}

// Across the plane a point is known as well as its distance: the share is the same by the intercept theorem.
double pointSigma(const GroundPoint& point, double height) {
  return height * std::hypot(point.depth_sigma, surface_sigma);
}

bool isOn(const Plane& plane, double height, const GroundPoint& point) {
  const double allowed = std::min(inlier_sigmas * pointSigma(point, height), widest_inlier * height);
  return std::abs(heightOver(plane, point.position)) <= allowed;
}

bool isBelow(const Plane& plane, double height, const GroundPoint& point) {
  return heightOver(plane, point.position) < -std::max(clearly_below * height, 4 * pointSigma(point, height));
}

Eigen::Vector3d meanUp(const GroundScene& scene) { return meanOf(scene.ups).normalized(); }

std::optional<Plane> planeThrough(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                                  const Eigen::Vector3d& up, double least_cosine) {
  Eigen::Vector3d normal = (b - a).cross(c - a);
  if (!(normal.norm() > 1e-9 * ((b - a).norm() * (c - a).norm()))) return std::nullopt;
  normal.normalize();
  if (normal.dot(up) < 0) normal = -normal;
  if (!(normal.dot(up) >= least_cosine)) return std::nullopt;
  return Plane{normal, normal.dot(a)};
}

struct Found {
  Plane plane;
  double height = 0;
  std::vector<const GroundPoint*> points;  // on it
};

Found pointsOn(const Plane& plane, const std::vector<const GroundPoint*>& candidates, const GroundScene& scene) {
  Found found{plane, meanHeight(plane, scene.cameras), {}};
  for (const GroundPoint* point : candidates) {
    const double distance = (point->position - scene.cameras[point->camera]).norm();
    if (isOn(plane, found.height, *point) && distance <= farthest * found.height) found.points.push_back(point);
  }
  return found;
}

bool camerasAreAbove(const Plane& plane, const GroundScene& scene) {
  return std::all_of(scene.cameras.begin(), scene.cameras.end(),
                     [&](const Eigen::Vector3d& camera) { return heightOver(plane, camera) > 0; });
}

std::optional<Found> bestPlane(const std::vector<const GroundPoint*>& candidates, const GroundScene& scene,
                               const Eigen::Vector3d& up, const GroundOptions& options) {
  if (candidates.size() < 3) return std::nullopt;
  const double least_cosine = std::cos(radians(options.largest_tilt_deg));
  std::mt19937 generator(1);
  const auto any = [&]() -> const Eigen::Vector3d& { return candidates[generator() % candidates.size()]->position; };
  std::optional<Found> best;
  for (int i = 0; i < samples; ++i) {
    const Eigen::Vector3d &a = any(), &b = any(), &c = any();
    const std::optional<Plane> plane = planeThrough(a, b, c, up, least_cosine);
    if (!plane || !camerasAreAbove(*plane, scene)) continue;
    Found found = pointsOn(*plane, candidates, scene);
    if (!best || found.points.size() > best->points.size()) best = std::move(found);
  }
  return best;
}

// Height over the plane = x * a + y * b + c, x and y in two directions along it from the points' middle: least squares
// over points whose errors are independent of each other but along an edge.
struct Fit {
  Plane plane;
  Eigen::Vector3d middle, along, across;
  Eigen::Matrix3d covariance;  // of (slope along, slope across, offset)
  double extent = 0;           // standard deviation of the points in the direction where it is smallest
  int edges = 0;
};

Fit fitted(const Found& found) {
  Fit fit;
  std::set<int> edges;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const GroundPoint* point : found.points) {
    sum += point->position;
    edges.insert(point->edge);
  }
  const auto count = static_cast<double>(found.points.size());
  fit.edges = static_cast<int>(edges.size());
  fit.middle = sum / count;
  fit.along = found.plane.normal.unitOrthogonal();
  fit.across = found.plane.normal.cross(fit.along);
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  for (const GroundPoint* point : found.points) {
    const Eigen::Vector3d from_middle = point->position - fit.middle;
    const Eigen::Vector3d row(from_middle.dot(fit.along), from_middle.dot(fit.across), 1);
    const double weight = 1 / std::pow(pointSigma(*point, found.height), 2);
    information += weight * row * row.transpose();
    gradient += weight * row * from_middle.dot(found.plane.normal);
    spread += row.head<2>() * row.head<2>().transpose() / count;
  }
  const Eigen::LDLT<Eigen::Matrix3d> solver(information);
  const Eigen::Vector3d slopes = solver.solve(gradient);
  fit.plane.normal = (found.plane.normal - slopes.x() * fit.along - slopes.y() * fit.across).normalized();
  fit.plane.offset = fit.plane.normal.dot(fit.middle + slopes.z() * found.plane.normal);
  double squares = 0;
  for (const GroundPoint* point : found.points) {
    squares += std::pow(heightOver(fit.plane, point->position) / pointSigma(*point, found.height), 2);
  }
  const double scatter = std::max(1.0, squares / std::max(1.0, count - 3)) * count / std::max(1, fit.edges);
  fit.covariance = scatter * solver.solve(Eigen::Matrix3d::Identity());
  fit.extent = std::sqrt(std::max(0.0, Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spread).eigenvalues()[0]));
  return fit;
}

// Standard deviation of the height of a place above the plane.
double heightSigma(const Fit& fit, const Eigen::Vector3d& place) {
  const Eigen::Vector3d from_middle = place - fit.middle;
  const Eigen::Vector3d row(from_middle.dot(fit.along), from_middle.dot(fit.across), 1);
  return std::sqrt(std::max(0.0, row.dot(fit.covariance * row)));
}

std::string percent(double share) { return std::to_string(std::lround(100 * std::min(share, 1e6))) + " %"; }

// Empty where the plane is one to go by.
std::string problemOf(const Fit& fit, const Found& found, int below, const GroundScene& scene,
                      const GroundOptions& options) {
  const auto on = static_cast<int>(found.points.size());
  if (on < options.fewest_points || fit.edges < options.fewest_edges) {
    return "no ground seen: at most " + std::to_string(on) + " points on " + std::to_string(fit.edges) +
           " edges lie in a plane square to the body's z axis";
  }
  // Refined, a plane leaves the samples' bound where a steeper one is near.
  const double tilt_deg = degrees(std::acos(std::clamp(fit.plane.normal.dot(meanUp(scene)), -1.0, 1.0)));
  if (tilt_deg > options.largest_tilt_deg) {
    return "the plane is " + std::to_string(std::lround(tilt_deg)) + " degrees off what the body's z axis says";
  }
  if (fit.extent < least_extent * found.height) return "the ground's points lie along one line";
  if (below > std::max(3.0, most_below * on)) {
    return std::to_string(below) + " points lie below the plane of " + std::to_string(on) + ": it is no ground";
  }
  double lowest = HUGE_VAL, highest = 0;
  for (const Eigen::Vector3d& camera : scene.cameras) {
    lowest = std::min(lowest, heightOver(fit.plane, camera));
    highest = std::max(highest, heightOver(fit.plane, camera));
  }
  const double spread = (highest - lowest) / found.height;
  if (spread > largest_height_spread) {
    return "the camera's height over the plane varies by " + percent(spread) +
           ": the ground is not level, or no ground";
  }
  return "";
}

// The lowest of several: as long as enough of what lies below a plane lies in another one.
std::optional<Found> lowestPlane(const std::vector<const GroundPoint*>& points, const GroundScene& scene,
                                 const GroundOptions& options) {
  const Eigen::Vector3d up = meanUp(scene);
  std::vector<const GroundPoint*> candidates = points;
  std::optional<Found> lowest;
  for (int i = 0; i < most_planes; ++i) {
    std::optional<Found> lower = bestPlane(candidates, scene, up, options);
    if (!lower || (lowest && static_cast<int>(lower->points.size()) < options.fewest_points)) break;
    lowest = std::move(lower);
    candidates.clear();
    for (const GroundPoint* point : points) {
      if (isBelow(lowest->plane, lowest->height, *point)) candidates.push_back(point);
    }
  }
  return lowest;
}

// Least squares; then anew with the points that lie on the better plane.
Fit refined(Found& found, const std::vector<const GroundPoint*>& points, const GroundScene& scene) {
  Fit fit = fitted(found);
  for (int i = 0; i < 2; ++i) {
    found = pointsOn(fit.plane, points, scene);
    if (found.points.size() < 3) break;
    fit = fitted(found);
  }
  found.height = meanHeight(fit.plane, scene.cameras);
  return fit;
}

GroundPlane refusal(const std::string& problem) {
  GroundPlane ground;
  ground.problem = problem;
  return ground;
}

}  // namespace

GroundPlane findGround(const GroundScene& scene, const GroundOptions& options) {
  if (static_cast<int>(scene.cameras.size()) < options.fewest_keyframes) {
    return refusal(std::to_string(scene.cameras.size()) + " of " + std::to_string(options.fewest_keyframes) +
                   " keyframes so far");
  }
  std::vector<const GroundPoint*> points;
  for (const GroundPoint& point : scene.points) points.push_back(&point);
  std::optional<Found> found = lowestPlane(points, scene, options);
  if (!found) return refusal("no plane square to the body's z axis (camera.body_T_camera) lies below the camera");
  const Fit fit = refined(*found, points, scene);
  const auto below = std::count_if(points.begin(), points.end(),
                                   [&](const GroundPoint* point) { return isBelow(fit.plane, found->height, *point); });
  GroundPlane ground;
  ground.problem = problemOf(fit, *found, static_cast<int>(below), scene, options);
  ground.normal = fit.plane.normal;
  ground.offset = fit.plane.offset;
  ground.height = found->height;
  ground.sigma = heightSigma(fit, meanOf(scene.cameras)) / found->height;
  ground.points = static_cast<int>(found->points.size());
  return ground;
}

}  // namespace edgeslam
