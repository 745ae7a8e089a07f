#include "adjustment/bundle_linearization.h"

#include <algorithm>
#include <cmath>

#include "adjustment/bundle_inertia.h"
#include "adjustment/bundle_lines.h"
#include "adjustment/damping.h"
#include "adjustment/index.h"

namespace edgeslam {
namespace {

double priorCost(const StructuredPoint& point, double inverse_depth) {
  const double error = inverse_depth - point.prior_inverse_depth;
  return 0.5 * point.prior_information * error * error;
}

void clear(const BundleStructure& structure, BundleLinearization& linearization) {
  linearization.cost = 0;
  linearization.blocks.assign(structure.places.size(), Matrix6d::Zero());
  linearization.pairs.assign(structure.places.size(), Matrix6d::Zero());
  linearization.diagonal.assign(structure.camera_of_unknown.size(), Matrix6d::Zero());
  const auto unknowns = static_cast<Eigen::Index>(6 * structure.camera_of_unknown.size());
  linearization.gradient.setZero(unknowns);
  linearization.camera_gradient.setZero(unknowns);
  linearization.points.resize(structure.points.size());
  linearization.mixed.resize(structure.observations.size());
}

// Adds first first^T + second second^T: the lower triangle, and what shares a packet of two with it.
inline void addOuterProducts(const Vector6d& first, const Vector6d& second, Matrix6d& block) {
  for (int j = 0; j < 2; ++j) block.col(j) += first(j) * first + second(j) * second;
  for (int j = 2; j < 4; ++j) block.col(j).tail<4>() += first(j) * first.tail<4>() + second(j) * second.tail<4>();
  for (int j = 4; j < 6; ++j) block.col(j).tail<2>() += first(j) * first.tail<2>() + second(j) * second.tail<2>();
}

// Normal equations of one point; kept from point to point for their memory.
struct PointEquations {
  double information = 0, gradient = 0;                      // of the inverse depth
  std::vector<Vector6d> mixed;                               // of the inverse depth with each viewer's twist
  Eigen::Vector3d sight_mixed = Eigen::Vector3d::Zero();     // of the inverse depth with the sights, summed
  Eigen::Vector3d sight_gradient = Eigen::Vector3d::Zero();  // by the sights, summed
};

class Linearizer {
 public:
  Linearizer(const Camera& camera, const BundleStructure& structure, const BundleState& state, double huber,
             double damping, BundleLinearization& linearization)
      : camera_(camera),
        structure_(structure),
        state_(state),
        huber_(huber),
        damping_(damping),
        linearization_(linearization) {}

  void addPoint(std::size_t index) {
    const StructuredPoint& point = structure_.points[index];
    EliminatedPoint& eliminated = linearization_.points[index];
    const CameraFrame& host = state_.frames[at(point.host)];
    eliminated.inverse_depth = state_.inverse_depths[index];
    const Eigen::Vector3d ray = host.world_R_camera * point.host_bearing;
    host_centre_ = hostCentre(point, host);
    eliminated.lever = ray + eliminated.inverse_depth * (host_centre_ - linearization_.origin);
    equations_.information = point.prior_information;
    equations_.gradient = point.prior_information * (eliminated.inverse_depth - point.prior_inverse_depth);
    equations_.mixed.assign(at(point.end_viewer - point.first_viewer), Vector6d::Zero());
    equations_.sight_mixed.setZero();
    equations_.sight_gradient.setZero();
    linearization_.cost += priorCost(point, eliminated.inverse_depth);
    for (int k = point.first_observation; k < point.end_observation; ++k) addObservation(point, eliminated, ray, k);
    addHost(point, eliminated);
    eliminate(point, eliminated);
  }

 private:
  void addObservation(const StructuredPoint& point, const EliminatedPoint& eliminated, const Eigen::Vector3d& ray,
                      int k) {
    const StructuredObservation& o = structure_.observations[at(k)];
    CameraFrame row;
    const CameraFrame& target = targetFrame(structure_, state_, o, row);
    const Eigen::Vector3d baseline = host_centre_ - target.centre;
    Eigen::Vector3d& mixed = linearization_.mixed[at(k)];
    Eigen::Vector2d residual;
    Matrix23d by_sight;
    if (!sightResidual(camera_, o.measured, target, ray + eliminated.inverse_depth * baseline, residual, &by_sight)) {
      linearization_.cost += 0.5 * huberLoss(behind_norm * behind_norm, huber_);
      mixed.setZero();
      return;
    }
    const double squared_norm = residual.squaredNorm();
    linearization_.cost += 0.5 * huberLoss(squared_norm, huber_);
    if (squared_norm > huber_ * huber_) {
      const double root = std::sqrt(huber_ / std::sqrt(squared_norm));
      residual *= root;
      by_sight *= root;
    }
    const Eigen::Vector2d by_depth = by_sight * baseline;
    if (point.free) {
      mixed = by_sight.transpose() * by_depth;
      equations_.information += by_depth.squaredNorm();
      equations_.gradient += by_depth.dot(residual);
      equations_.sight_mixed += mixed;
      if (o.viewer >= 0) equations_.mixed[at(o.viewer)] -= byTwist(eliminated, mixed);
    }
    if (point.end_viewer > point.first_viewer) addToCameras(point, eliminated, o.viewer, by_sight, residual);
  }

  // From a gradient by the sight to that by a twist.
  // Spelt out: as an expression of vectors it makes the processor wait for its own stores.
  static Vector6d byTwist(const EliminatedPoint& point, double x, double y, double z) {
    Vector6d by_twist;
    by_twist.head<2>() = Eigen::Vector2d(point.inverse_depth * x, point.inverse_depth * y);
    by_twist.segment<2>(2) = Eigen::Vector2d(point.inverse_depth * z, point.lever.y() * z - point.lever.z() * y);
    by_twist.tail<2>() =
        Eigen::Vector2d(point.lever.z() * x - point.lever.x() * z, point.lever.x() * y - point.lever.y() * x);
    return by_twist;
  }
  static Vector6d byTwist(const EliminatedPoint& point, const Eigen::Vector3d& by_sight) {
    return byTwist(point, by_sight.x(), by_sight.y(), by_sight.z());
  }

  void addToCameras(const StructuredPoint& point, const EliminatedPoint& eliminated, int viewer,
                    const Matrix23d& by_sight, const Eigen::Vector2d& residual) {
    const Eigen::Vector3d gradient = by_sight.transpose() * residual;
    equations_.sight_gradient += gradient;
    Matrix6d* block = nullptr;
    if (viewer >= 0) {
      const int unknown = unknownOf(point, viewer);
      linearization_.camera_gradient.segment<6>(6 * unknown) -= byTwist(eliminated, gradient);
      block = point.host_viewer < 0 ? &linearization_.diagonal[at(unknown)]
                                    : &linearization_.pairs[at(blockOf(point, viewer, point.host_viewer))];
    } else if (point.host_viewer >= 0) {
      block = &linearization_.diagonal[at(unknownOf(point, point.host_viewer))];
    } else {
      return;  // another of the point's targets is free
    }
    addOuterProducts(byTwist(eliminated, by_sight(0, 0), by_sight(0, 1), by_sight(0, 2)),
                     byTwist(eliminated, by_sight(1, 0), by_sight(1, 1), by_sight(1, 2)), *block);
  }

  int unknownOf(const StructuredPoint& point, int viewer) const {
    return structure_.viewers[at(point.first_viewer + viewer)];
  }
  int blockOf(const StructuredPoint& point, int viewer, int other) const {
    return structure_.blocks[at(point.first_block + blockOfPair(std::max(viewer, other), std::min(viewer, other)))];
  }

  void addHost(const StructuredPoint& point, const EliminatedPoint& eliminated) {
    if (point.host_viewer < 0) return;
    linearization_.camera_gradient.segment<6>(6 * unknownOf(point, point.host_viewer)) +=
        byTwist(eliminated, equations_.sight_gradient);
    equations_.mixed[at(point.host_viewer)] += byTwist(eliminated, equations_.sight_mixed);
  }

  void eliminate(const StructuredPoint& point, EliminatedPoint& eliminated) {
    eliminated.gradient = equations_.gradient;
    eliminated.inverse_information = 0;
    if (!point.free || !(equations_.information > 0)) return;
    eliminated.inverse_information =
        1 / (equations_.information + damping_ * std::max(equations_.information, least_information));
    const int* block = structure_.blocks.data() + point.first_block;
    for (std::size_t row = 0; row < equations_.mixed.size(); ++row) {
      const Vector6d scaled = eliminated.inverse_information * equations_.mixed[row];
      const int unknown = structure_.viewers[at(point.first_viewer) + row];
      linearization_.gradient.segment<6>(6 * unknown) -= equations_.gradient * scaled;
      for (std::size_t column = 0; column <= row; ++column) {
        linearization_.blocks[at(*block++)].noalias() -= scaled * equations_.mixed[column].transpose();
      }
    }
  }

  const Camera& camera_;
  const BundleStructure& structure_;
  const BundleState& state_;
  double huber_, damping_;
  BundleLinearization& linearization_;
  PointEquations equations_;
  Eigen::Vector3d host_centre_ = Eigen::Vector3d::Zero();  // of the point at hand
};

void mirrorLowerTriangle(Matrix6d& block) {
  for (int j = 1; j < 6; ++j) {
    for (int i = 0; i < j; ++i) block(i, j) = block(j, i);
  }
}

// What a pair's residuals say of its difference, on the diagonal of both and, negative, between them.
void joinBlocks(const BundleStructure& structure, BundleLinearization& linearization) {
  for (std::size_t b = 0; b < structure.places.size(); ++b) {
    const BlockPlace place = structure.places[b];
    if (place.row == place.column) continue;
    Matrix6d& pair = linearization.pairs[b];
    mirrorLowerTriangle(pair);
    linearization.blocks[b] -= pair;
    linearization.diagonal[at(place.row)] += pair;
    linearization.diagonal[at(place.column)] += pair;
  }
  for (std::size_t b = 0; b < structure.places.size(); ++b) {
    const BlockPlace place = structure.places[b];
    if (place.row != place.column) continue;
    mirrorLowerTriangle(linearization.diagonal[at(place.row)]);
    linearization.blocks[b] += linearization.diagonal[at(place.row)];
  }
}

}  // namespace

double bundleCost(const Camera& camera, const BundleProblem& problem, const BundleStructure& structure,
                  const BundleState& state, double huber) {
  double cost = 0;
  for (std::size_t i = 0; i < structure.points.size(); ++i) {
    const StructuredPoint& point = structure.points[i];
    const CameraFrame& host = state.frames[at(point.host)];
    const Eigen::Vector3d ray = host.world_R_camera * point.host_bearing;
    const Eigen::Vector3d host_centre = hostCentre(point, host);
    cost += priorCost(point, state.inverse_depths[i]);
    for (int k = point.first_observation; k < point.end_observation; ++k) {
      const StructuredObservation& o = structure.observations[at(k)];
      CameraFrame row;
      const CameraFrame& target = targetFrame(structure, state, o, row);
      Eigen::Vector2d residual(behind_norm, 0);
      sightResidual(camera, o.measured, target, ray + state.inverse_depths[i] * (host_centre - target.centre), residual,
                    nullptr);
      cost += 0.5 * huberLoss(residual.squaredNorm(), huber);
    }
  }
  return cost + lineCost(structure, state, huber) + inertialCost(problem, structure, state, huber);
}

void linearizeBundle(const Camera& camera, const BundleProblem& problem, const BundleStructure& structure,
                     const BundleState& state, double huber, double damping, BundleLinearization& linearization) {
  clear(structure, linearization);
  Linearizer linearizer(camera, structure, state, huber, damping, linearization);
  for (std::size_t i = 0; i < structure.points.size(); ++i) linearizer.addPoint(i);
  linearizeLines(structure, state, huber, damping, linearization);
  linearizeInertia(problem, structure, state, huber, linearization);
  joinBlocks(structure, linearization);
  linearization.gradient += linearization.camera_gradient;
}

void changeDepths(const BundleStructure& structure, const BundleLinearization& linearization,
                  const Eigen::VectorXd& twists, std::vector<double>& changes) {
  const auto twistOf = [&](const StructuredPoint& point, int viewer) -> Vector6d {
    if (viewer < 0) return Vector6d::Zero();
    return twists.segment<6>(6 * structure.viewers[at(point.first_viewer + viewer)]);
  };
  changes.resize(structure.points.size());
  for (std::size_t i = 0; i < structure.points.size(); ++i) {
    const StructuredPoint& point = structure.points[i];
    const EliminatedPoint& eliminated = linearization.points[i];
    changes[i] = 0;
    if (eliminated.inverse_information == 0) continue;
    const Vector6d host = twistOf(point, point.host_viewer);
    double gradient = eliminated.gradient;
    for (int k = point.first_observation; k < point.end_observation; ++k) {
      const Vector6d twist = host - twistOf(point, structure.observations[at(k)].viewer);
      const Eigen::Vector3d sight_change =
          eliminated.inverse_depth * twist.head<3>() + twist.tail<3>().cross(eliminated.lever);
      gradient += linearization.mixed[at(k)].dot(sight_change);
    }
    changes[i] = -eliminated.inverse_information * gradient;
  }
}

}  // namespace edgeslam
