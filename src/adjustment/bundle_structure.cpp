#include "adjustment/bundle_structure.h"

#include <algorithm>
#include <cmath>

#include "adjustment/index.h"

namespace edgeslam {
namespace {

bool takesPart(const BundleProblem& problem, const BundleObservation& o) {
  const BundlePoint& p = problem.points[at(o.point)];
  if (p.host == o.camera || !usable(p) || !usable(o.measurement)) return false;
  return !p.fixed || !problem.cameras[at(p.host)].fixed || !problem.cameras[at(o.camera)].fixed;
}

bool takesPart(const BundleProblem& problem, const BundleLineObservation& o) {
  const BundleLine& line = problem.lines[at(o.line)];
  return usable(line) && usable(o) && !(line.fixed && problem.cameras[at(o.camera)].fixed);
}

std::array<int, 2> camerasOf(const BundleTurn& turn) { return {turn.first, turn.second}; }
std::array<int, 2> camerasOf(const BundleWay& way) { return {way.first, way.second}; }
const std::array<int, 3>& camerasOf(const BundleSpeedChange& change) { return change.cameras; }

int landmarkOf(const BundleObservation& o) { return o.point; }
int landmarkOf(const BundleLineObservation& o) { return o.line; }

// Of the observations that take part; `landmarks`: how many points or lines there are.
template <typename Observation>
void orderObservations(const BundleProblem& problem, const std::vector<Observation>& observations,
                       std::size_t landmarks, ObservationOrder& ordered) {
  std::vector<int>& first = ordered.first;
  first.assign(landmarks + 1, 0);
  for (const Observation& o : observations) first[at(landmarkOf(o)) + 1] += takesPart(problem, o);
  for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
  ordered.order.resize(at(first.back()));
  for (std::size_t k = 0; k < observations.size(); ++k) {
    const Observation& o = observations[k];
    if (takesPart(problem, o)) ordered.order[at(first[at(landmarkOf(o))]++)] = static_cast<int>(k);
  }
  // Each now stands where the next point or line begins.
  for (std::size_t i = first.size() - 1; i > 0; --i) first[i] = first[i - 1];
  first[0] = 0;
  const auto earlier = [&](int a, int b) {
    const int camera_a = observations[at(a)].camera, camera_b = observations[at(b)].camera;
    return camera_a != camera_b ? camera_a < camera_b : a < b;
  };
  for (std::size_t i = 0; i + 1 < first.size(); ++i) {
    const auto begin = ordered.order.begin() + first[i], end = ordered.order.begin() + first[i + 1];
    if (!std::is_sorted(begin, end, earlier)) std::sort(begin, end, earlier);
  }
}

void nameUnknowns(const BundleProblem& problem, BundleStructure& structure) {
  structure.unknown_of_camera.assign(problem.cameras.size(), -1);
  const auto use = [&](int camera) {
    if (!problem.cameras[at(camera)].fixed) structure.unknown_of_camera[at(camera)] = 0;
  };
  for (const int k : structure.of_points.order) {
    const BundleObservation& o = problem.observations[at(k)];
    use(o.camera);
    use(problem.points[at(o.point)].host);
  }
  for (const int k : structure.of_lines.order) use(problem.line_observations[at(k)].camera);
  for (const BundleWay& way : problem.ways) {  // it may be all that is known of a camera
    if (!usable(way)) continue;
    use(way.first);
    use(way.second);
  }
  structure.camera_of_unknown.clear();
  for (std::size_t c = 0; c < problem.cameras.size(); ++c) {
    if (structure.unknown_of_camera[c] < 0) continue;
    structure.unknown_of_camera[c] = static_cast<int>(structure.camera_of_unknown.size());
    structure.camera_of_unknown.push_back(static_cast<int>(c));
  }
}

// The structure's row in which a camera reads this one of its image; -1: it does not move meanwhile.
int addRow(const Camera& camera, const BundleCamera& target, double row, BundleStructure& structure) {
  if (camera.readout_s == 0 || target.twist.isZero(0)) return -1;
  structure.rows.push_back(cameraFrame(rowPose(camera, target.twist, row)));
  return static_cast<int>(structure.rows.size()) - 1;
}

// Lists an unknown as a viewer of a point or line, unless it was the last; its number among the viewers from `first`
// on.
int listViewer(int unknown, int first, std::vector<int>& viewers) {
  if (static_cast<int>(viewers.size()) == first || viewers.back() != unknown) viewers.push_back(unknown);
  return static_cast<int>(viewers.size()) - 1 - first;
}

// Copies the point's observations and lists its viewers.
void addPoint(const Camera& camera, const BundleProblem& problem, int index, BundleStructure& structure) {
  const int first = structure.of_points.first[at(index)], end = structure.of_points.first[at(index) + 1];
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
  const auto list = [&](int unknown) { return listViewer(unknown, point.first_viewer, structure.viewers); };
  for (int k = first; k < end; ++k) {
    const BundleObservation& o = problem.observations[at(structure.of_points.order[at(k)])];
    const int unknown = structure.unknown_of_camera[at(o.camera)];
    if (!host_listed && unknown > host_unknown) {
      point.host_viewer = list(host_unknown);
      host_listed = true;
    }
    const int row = addRow(camera, problem.cameras[at(o.camera)], o.measurement.pixel.y(), structure);
    structure.observations.push_back(
        {{o.measurement.pixel, whitening(o.measurement)}, o.camera, unknown < 0 ? -1 : list(unknown), row});
  }
  if (!host_listed) point.host_viewer = list(host_unknown);
  point.end_viewer = static_cast<int>(structure.viewers.size());
  structure.points.push_back(point);
}

// Likewise the line's.
void addLine(const Camera& camera, const BundleProblem& problem, int index, BundleStructure& structure) {
  const int first = structure.of_lines.first[at(index)], end = structure.of_lines.first[at(index) + 1];
  if (first == end) return;
  StructuredLine line;
  line.index = index;
  line.free = !problem.lines[at(index)].fixed;
  line.first_observation = first;
  line.end_observation = end;
  line.first_viewer = static_cast<int>(structure.line_viewers.size());
  for (int k = first; k < end; ++k) {
    const BundleLineObservation& o = problem.line_observations[at(structure.of_lines.order[at(k)])];
    const int unknown = structure.unknown_of_camera[at(o.camera)];
    const int viewer = unknown < 0 ? -1 : listViewer(unknown, line.first_viewer, structure.line_viewers);
    const int row = addRow(camera, problem.cameras[at(o.camera)], o.row, structure);
    structure.line_observations.push_back({o.bearing, o.sigma, o.camera, viewer, row});
  }
  line.end_viewer = static_cast<int>(structure.line_viewers.size());
  structure.lines.push_back(line);
}

// Those that take part: of usable values, and of a free camera.
template <typename Term>
void addInertia(const std::vector<Term>& terms, const std::vector<int>& unknown_of_camera,
                std::vector<StructuredInertia>& structured) {
  structured.clear();
  for (std::size_t i = 0; i < terms.size(); ++i) {
    if (!usable(terms[i])) continue;
    StructuredInertia inertia;
    inertia.index = static_cast<int>(i);
    const auto cameras = camerasOf(terms[i]);
    bool is_free = false;
    for (std::size_t k = 0; k < cameras.size(); ++k) {
      inertia.cameras[k] = cameras[k];
      inertia.unknowns[k] = unknown_of_camera[at(cameras[k])];
      is_free |= inertia.unknowns[k] >= 0;
    }
    if (is_free) structured.push_back(inertia);
  }
}

// Calls function(number of the pair, unknown, unknown) for what both are free.
template <typename Function>
void forEachPair(const StructuredInertia& inertia, const Function& function) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column <= row; ++column) {
      const int a = inertia.unknowns[at(row)], b = inertia.unknowns[at(column)];
      if (a >= 0 && b >= 0) function(blockOfPair(row, column), std::max(a, b), std::min(a, b));
    }
  }
}

// Of a point or line, with the viewers of its kind.
template <typename Landmark, typename Function>
void forEachPair(const Landmark& landmark, const std::vector<int>& viewers, const Function& function) {
  for (int row = landmark.first_viewer; row < landmark.end_viewer; ++row) {
    for (int column = landmark.first_viewer; column <= row; ++column) {
      function(viewers[at(row)], viewers[at(column)]);
    }
  }
}

// All blocks of the lower triangle, or those that some point, line or inertia asks for.
void placeBlocks(int most_dense, BundleStructure& structure) {
  const std::size_t unknowns = structure.camera_of_unknown.size();
  structure.dense = unknowns <= at(most_dense);
  // Not a list of what is asked for, which is long: most pairs of cameras see many points together.
  constexpr int nobody_asks = -1, asked = 0;
  std::vector<int>& block_of_pair = structure.block_of_pair;
  block_of_pair.assign(unknowns * unknowns, structure.dense ? asked : nobody_asks);
  const auto blockOf = [&](int row, int column) -> int& { return block_of_pair[at(column) * unknowns + at(row)]; };
  if (!structure.dense) {
    const auto ask = [&](int row, int column) { blockOf(row, column) = asked; };
    for (const StructuredPoint& point : structure.points) forEachPair(point, structure.viewers, ask);
    for (const StructuredLine& line : structure.lines) forEachPair(line, structure.line_viewers, ask);
    for (const auto* inertia : {&structure.turns, &structure.speed_changes, &structure.ways}) {
      for (const StructuredInertia& term : *inertia) {
        forEachPair(term, [&](int, int row, int column) { ask(row, column); });
      }
    }
  }
  structure.places.clear();
  for (int column = 0; at(column) < unknowns; ++column) {
    for (int row = column; at(row) < unknowns; ++row) {
      if (blockOf(row, column) == nobody_asks) continue;
      blockOf(row, column) = static_cast<int>(structure.places.size());
      structure.places.push_back({row, column});
    }
  }
  const auto place = [&](auto& landmarks, const std::vector<int>& viewers, std::vector<int>& blocks) {
    blocks.clear();
    for (auto& landmark : landmarks) {
      landmark.first_block = static_cast<int>(blocks.size());
      forEachPair(landmark, viewers, [&](int row, int column) { blocks.push_back(blockOf(row, column)); });
    }
  };
  place(structure.points, structure.viewers, structure.blocks);
  place(structure.lines, structure.line_viewers, structure.line_blocks);
  for (auto* inertia : {&structure.turns, &structure.speed_changes, &structure.ways}) {
    for (StructuredInertia& term : *inertia) {
      forEachPair(term, [&](int pair, int row, int column) { term.blocks[at(pair)] = blockOf(row, column); });
    }
  }
}

// False also for what is no number.
bool isUnit(const Eigen::Vector3d& v) {
  constexpr double tolerance = 1e-3;
  return std::abs(v.squaredNorm() - 1) < tolerance;
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

bool usable(const BundleLine& line) { return line.line.point.allFinite() && isUnit(line.line.direction); }

bool usable(const BundleLineObservation& observation) {
  return isUnit(observation.bearing) && std::isfinite(observation.row) && std::isfinite(observation.sigma) &&
         observation.sigma > 0;
}

bool usable(const BundleTurn& turn) {
  return turn.first_R_second.coeffs().allFinite() && turn.whitening.allFinite() && turn.first != turn.second;
}

bool usable(const BundleWay& way) {
  return way.way.allFinite() && way.whitening.allFinite() && way.first != way.second;
}

bool usable(const BundleSpeedChange& change) {
  return change.of_first.allFinite() && change.of_second.allFinite() && change.whitening.allFinite() &&
         change.seconds[0] > 0 && change.seconds[1] > 0 && std::isfinite(change.seconds[0] + change.seconds[1]) &&
         change.cameras[0] != change.cameras[1] && change.cameras[1] != change.cameras[2] &&
         change.cameras[0] != change.cameras[2];
}

void structureBundle(const Camera& camera, const BundleProblem& problem, int most_dense, BundleStructure& structure) {
  orderObservations(problem, problem.observations, problem.points.size(), structure.of_points);
  orderObservations(problem, problem.line_observations, problem.lines.size(), structure.of_lines);
  nameUnknowns(problem, structure);
  structure.points.clear();
  structure.observations.clear();
  structure.rows.clear();
  structure.viewers.clear();
  structure.lines.clear();
  structure.line_observations.clear();
  structure.line_viewers.clear();
  // Of a whole map these are large: growing by doubling would take up to three times as much.
  structure.points.reserve(problem.points.size());
  structure.observations.reserve(problem.observations.size());
  structure.viewers.reserve(problem.points.size() + problem.observations.size());
  for (std::size_t i = 0; i < problem.points.size(); ++i) addPoint(camera, problem, static_cast<int>(i), structure);
  for (std::size_t i = 0; i < problem.lines.size(); ++i) addLine(camera, problem, static_cast<int>(i), structure);
  addInertia(problem.turns, structure.unknown_of_camera, structure.turns);
  addInertia(problem.speed_changes, structure.unknown_of_camera, structure.speed_changes);
  addInertia(problem.ways, structure.unknown_of_camera, structure.ways);
  placeBlocks(most_dense, structure);
}

}  // namespace edgeslam
