// A house of which only the edges are seen, by cameras that go around it: bundle problems of lines whose solution is
// known.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "adjustment/bundle_adjustment.h"
#include "geometry/space_line.h"
#include "unit/adjustment/synthetic_bundle.h"

namespace edgeslam::test {

constexpr double house_sigma = 0.3 / 400;  // of a line's end: 0.3 px [rad]

struct HouseOptions {
  int cameras = 8;  // the first two are fixed
  int points = 0;   // on the house, hosted by the cameras in turn, each seen by all the others
  double noise = 0;
};

// From its middle to an end.
struct HouseEdge {
  Eigen::Vector3d middle, half;
};

// Walls of 2 x 2 x 1.5 units without the lower edges of two of them, a ridge, and rafters to its ends.
inline std::vector<HouseEdge> houseEdges() {
  constexpr std::array<std::array<double, 2>, 4> corners{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  std::vector<HouseEdge> edges;
  const auto add = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    edges.push_back({(from + to) / 2, (to - from) / 2});
  };
  for (const auto& [x, y] : corners) {
    add({x, y, 0}, {x, y, 1.5});
    add({x, y, 1.5}, {0, 0.7 * y, 2.3});
  }
  add({-1, -1, 0}, {1, -1, 0});
  add({1, -1, 0}, {1, 1, 0});
  add({-1, 1, 1.5}, {1, 1, 1.5});
  add({0, -0.7, 2.3}, {0, 0.7, 2.3});
  return edges;
}

// At `centre`, looking at the middle of the house.
inline Pose lookingAtHouse(const Eigen::Vector3d& centre) {
  Eigen::Matrix3d world_R_camera;
  world_R_camera.col(2) = (Eigen::Vector3d(0, 0, 1) - centre).normalized();
  world_R_camera.col(0) = world_R_camera.col(2).cross(Eigen::Vector3d::UnitZ()).normalized();
  world_R_camera.col(1) = world_R_camera.col(2).cross(world_R_camera.col(0));
  return {Eigen::Quaterniond(world_R_camera), centre};
}

// Both ends of an edge as a camera sees them, which may be beyond the image.
inline void addEdgeView(Random& random, const HouseEdge& edge, int camera, int line, double noise,
                        BundleProblem& problem) {
  const Pose camera_T_world = problem.cameras[static_cast<std::size_t>(camera)].world_T_camera.inverse();
  for (const double end : {-1.0, 1.0}) {
    const Eigen::Vector3d seen = (camera_T_world * (edge.middle + end * edge.half)).normalized();
    const Eigen::Vector3d error(gaussian(random, noise * house_sigma), gaussian(random, noise * house_sigma),
                                gaussian(random, noise * house_sigma));
    BundleLineObservation o;
    o.camera = camera;
    o.line = line;
    o.bearing = (seen + error).normalized();
    o.sigma = house_sigma;
    problem.line_observations.push_back(o);
  }
}

inline void addHousePoints(Random& random, const Camera& camera, const HouseOptions& options, BundleProblem& problem) {
  for (int i = 0; i < options.points; ++i) {
    const Eigen::Vector3d world = uniformVector(random, 1) + Eigen::Vector3d(0, 0, 1);
    const auto seenBy = [&](int c) {
      return Eigen::Vector3d(problem.cameras[static_cast<std::size_t>(c)].world_T_camera.inverse() * world);
    };
    BundlePoint point;
    point.host = i % options.cameras;
    point.host_bearing = seenBy(point.host).normalized();
    point.inverse_depth = 1 / seenBy(point.host).norm();
    problem.points.push_back(point);
    for (int c = 0; c < options.cameras; ++c) {
      if (c == point.host) continue;
      BundleObservation o;
      o.camera = c;
      o.point = i;
      o.measurement =
          measure(random, project(camera, seenBy(c)), uniform(random, -M_PI, M_PI), 0.5, 0.5, options.noise);
      problem.observations.push_back(o);
    }
  }
}

inline BundleScene makeHouse(Random& random, const HouseOptions& options) {
  BundleScene scene;
  scene.camera = testCamera(CameraModel::pinhole_radial_tangential);
  BundleProblem& problem = scene.truth;
  for (int i = 0; i < options.cameras; ++i) {
    const double angle = 2 * M_PI * i / options.cameras;
    const Eigen::Vector3d centre(5 * std::cos(angle), 5 * std::sin(angle), 1 + 1.5 * std::sin(3 * angle));
    problem.cameras.push_back({lookingAtHouse(centre + uniformVector(random, 0.3)), i < 2});
  }
  for (const HouseEdge& edge : houseEdges()) {
    const int line = static_cast<int>(problem.lines.size());
    problem.lines.push_back({{edge.middle, edge.half.normalized()}});
    for (int c = 0; c < options.cameras; ++c) addEdgeView(random, edge, c, line, options.noise, problem);
  }
  addHousePoints(random, scene.camera, options, problem);
  return scene;
}

// The truth with all that is free moved: cameras and points as in perturbedProblem(), lines by up to 0.15 units and 0.1
// rad.
inline BundleProblem perturbedHouse(Random& random, const BundleProblem& truth) {
  BundleProblem problem = perturbedProblem(random, truth, 0.1, 0.03);
  for (BundleLine& line : problem.lines) {
    const double a = uniform(random, -0.1, 0.1), b = uniform(random, -0.1, 0.1);
    const double c = uniform(random, -0.07, 0.07), d = uniform(random, -0.07, 0.07);
    if (!line.fixed) line.line = movedLine(line.line, {a, b, c, d});
  }
  return problem;
}

// The change from a line to another that is nearly the same, wherever their points are.
inline Eigen::Vector4d changeBetween(const SpaceLine& from, const SpaceLine& to) {
  const LineBasis basis = lineBasis(from.direction);
  const Eigen::Vector3d slope = to.direction / to.direction.dot(from.direction);
  const Eigen::Vector3d beside = to.point + (from.point - to.point).dot(from.direction) * slope;
  Eigen::Vector4d change;
  change << basis.transpose() * (beside - from.point), basis.transpose() * slope;
  return change;
}

inline double largestLineError(const BundleProblem& a, const BundleProblem& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.lines.size(); ++i)
    largest = std::max(largest, changeBetween(a.lines[i].line, b.lines[i].line).norm());
  return largest;
}

inline bool sameLines(const BundleProblem& a, const BundleProblem& b) {
  return a.lines.size() == b.lines.size() &&
         std::equal(a.lines.begin(), a.lines.end(), b.lines.begin(), [](const BundleLine& x, const BundleLine& y) {
           return x.line.point == y.line.point && x.line.direction == y.line.direction;
         });
}

}  // namespace edgeslam::test
