#include "adjustment/bundle_structure.h"

#include <algorithm>
#include <cmath>

namespace edgeslam {
namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

bool takesPart(const BundleProblem& problem, const BundleObservation& o) {
  const BundlePoint& p = problem.points[at(o.point)];
  if (p.host == o.camera || !usable(p) || !usable(o.measurement)) return false;
  return !p.fixed || !problem.cameras[at(p.host)].fixed || !problem.cameras[at(o.camera)].fixed;
}

// Indices of the observations that take part, by point and camera, equal ones in the order given.
void orderObservations(const BundleProblem& problem, BundleStructure& structure) {
  std::vector<int>& first = structure.first_of_point;
  first.assign(problem.points.size() + 1, 0);
  for (const BundleObservation& o : problem.observations) first[at(o.point) + 1] += takesPart(problem, o);
  for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
  structure.order.resize(at(first.back()));
  for (std::size_t k = 0; k < problem.observations.size(); ++k) {
    const BundleObservation& o = problem.observations[k];
    if (takesPart(problem, o)) structure.order[at(first[at(o.point)]++)] = static_cast<int>(k);
  }
  // Each now stands where the next point begins.
  for (std::size_t i = first.size() - 1; i > 0; --i) first[i] = first[i - 1];
  first[0] = 0;
  const auto earlier = [&](int a, int b) {
    const int camera_a = problem.observations[at(a)].camera, camera_b = problem.observations[at(b)].camera;
    return camera_a != camera_b ? camera_a < camera_b : a < b;
  };
  for (std::size_t i = 0; i + 1 < first.size(); ++i) {
    const auto begin = structure.order.begin() + first[i], end = structure.order.begin() + first[i + 1];
    if (!std::is_sorted(begin, end, earlier)) std::sort(begin, end, earlier);
  }
}

void nameUnknowns(const BundleProblem& problem, BundleStructure& structure) {
  structure.unknown_of_camera.assign(problem.cameras.size(), -1);
  const auto use = [&](int camera) {
    if (!problem.cameras[at(camera)].fixed) structure.unknown_of_camera[at(camera)] = 0;
  };
  for (const int k : structure.order) {
    const BundleObservation& o = problem.observations[at(k)];
    use(o.camera);
    use(problem.points[at(o.point)].host);
  }
  structure.camera_of_unknown.clear();
  for (std::size_t c = 0; c < problem.cameras.size(); ++c) {
    if (structure.unknown_of_camera[c] < 0) continue;
    structure.unknown_of_camera[c] = static_cast<int>(structure.camera_of_unknown.size());
    structure.camera_of_unknown.push_back(static_cast<int>(c));
  }
}

// Copies the point's observations and lists its viewers.
void addPoint(const Camera& camera, const BundleProblem& problem, int index, BundleStructure& structure) {
  const int first = structure.first_of_point[at(index)], end = structure.first_of_point[at(index) + 1];
  if (first == end) return;
  const BundlePoint& p = problem.points[at(index)];
  StructuredPoint point;
  point.host_bearing = p.host_bearing;
  point.host_origin = p.host_origin;
  point.index = index;
  point.host = p.host;
  point.free = !p.fixed;
  if (p.prior_sigma > 0) {
    point.prior_information = 1 / (p.prior_sigma * p.prior_sigma);
    point.prior_inverse_depth = p.prior_inverse_depth;
  }
  point.first_observation = first;
  point.end_observation = end;
  point.first_viewer = static_cast<int>(structure.viewers.size());
  const int host_unknown = structure.unknown_of_camera[at(p.host)];
  bool host_listed = host_unknown < 0;
  const auto list = [&](int unknown) {
    if (static_cast<int>(structure.viewers.size()) == point.first_viewer || structure.viewers.back() != unknown)
      structure.viewers.push_back(unknown);
    return static_cast<int>(structure.viewers.size()) - 1 - point.first_viewer;
  };
  for (int k = first; k < end; ++k) {
    const BundleObservation& o = problem.observations[at(structure.order[at(k)])];
    const int unknown = structure.unknown_of_camera[at(o.camera)];
    if (!host_listed && unknown > host_unknown) {
      point.host_viewer = list(host_unknown);
      host_listed = true;
    }
    structure.observations.push_back(
        {{o.measurement.pixel, whitening(o.measurement)}, o.camera, unknown < 0 ? -1 : list(unknown), -1});
    const Twist& twist = problem.cameras[at(o.camera)].twist;
    if (camera.readout_s == 0 || twist.isZero(0)) continue;
    structure.observations.back().row = static_cast<int>(structure.rows.size());
    structure.rows.push_back(cameraFrame(rowPose(camera, twist, o.measurement.pixel.y())));
  }
  if (!host_listed) point.host_viewer = list(host_unknown);
  point.end_viewer = static_cast<int>(structure.viewers.size());
  structure.points.push_back(point);
}

template <typename Function>
void forEachPair(const BundleStructure& structure, const StructuredPoint& point, const Function& function) {
  for (int row = point.first_viewer; row < point.end_viewer; ++row) {
    for (int column = point.first_viewer; column <= row; ++column) {
      function(structure.viewers[at(row)], structure.viewers[at(column)]);
    }
  }
}

// All blocks of the lower triangle, or those that some point asks for.
void placeBlocks(int most_dense, BundleStructure& structure) {
  const auto unknowns = static_cast<std::int64_t>(structure.camera_of_unknown.size());
  structure.dense = unknowns <= most_dense;
  std::vector<std::int64_t>& pairs = structure.pairs;
  pairs.clear();
  const auto key = [&](int row, int column) { return column * unknowns + row; };
  if (structure.dense) {
    for (int column = 0; column < unknowns; ++column) {
      for (int row = column; row < unknowns; ++row) pairs.push_back(key(row, column));
    }
  } else {
    for (const StructuredPoint& point : structure.points) {
      forEachPair(structure, point, [&](int row, int column) { pairs.push_back(key(row, column)); });
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  }
  structure.places.clear();
  for (const std::int64_t pair : pairs) {
    structure.places.push_back({static_cast<int>(pair % unknowns), static_cast<int>(pair / unknowns)});
  }
  structure.blocks.clear();
  for (StructuredPoint& point : structure.points) {
    point.first_block = static_cast<int>(structure.blocks.size());
    forEachPair(structure, point, [&](int row, int column) {
      const std::int64_t before = column * unknowns - std::int64_t{column} * (column - 1) / 2;
      const std::int64_t block = structure.dense
                                     ? before + row - column
                                     : std::lower_bound(pairs.begin(), pairs.end(), key(row, column)) - pairs.begin();
      structure.blocks.push_back(static_cast<int>(block));
    });
  }
}

}  // namespace

bool usable(const BundlePoint& point) {
  return point.host_bearing.allFinite() && point.host_origin.allFinite() && point.inverse_depth > 0 &&
         std::isfinite(point.inverse_depth) && std::isfinite(point.prior_sigma) &&
         std::isfinite(point.prior_inverse_depth);
}

bool usable(const Measurement& measurement) {
  return measurement.pixel.allFinite() && measurement.normal.allFinite() && measurement.sigma_normal > 0 &&
         measurement.sigma_tangent > 0;
}

void structureBundle(const Camera& camera, const BundleProblem& problem, int most_dense, BundleStructure& structure) {
  orderObservations(problem, structure);
  nameUnknowns(problem, structure);
  structure.points.clear();
  structure.observations.clear();
  structure.rows.clear();
  structure.viewers.clear();
  for (std::size_t i = 0; i < problem.points.size(); ++i) addPoint(camera, problem, static_cast<int>(i), structure);
  placeBlocks(most_dense, structure);
}

}  // namespace edgeslam
