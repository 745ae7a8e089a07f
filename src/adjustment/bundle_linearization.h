// The normal equations of a bundle adjustment with the inverse depths and the lines eliminated, which leaves a system
// in the free cameras' poses alone (Triggs et al., Bundle Adjustment - A Modern Synthesis, 2000, section 6.1). A depth
// is one unknown, so its block is a number, and eliminating it a division.
//
// Every camera's motion is described by a twist [v; w] about one common origin o, world axes: a point X goes to
// X + v + w x (X - o). Then a residual depends on the difference of the host's and the target's twist only, and one
// derivative serves both. With z = R_h f + rho (c_h - o), the sight changes by rho v + w x z.
//
// What is said of lines is in bundle_lines.h, and of inertia in bundle_inertia.h.
#pragma once

#include <vector>

#include "adjustment/bundle_structure.h"

namespace edgeslam {

// What is adjusted.
struct BundleState {
  std::vector<Eigen::Quaterniond> rotations;  // world_R_camera of every camera
  std::vector<CameraFrame> frames;            // the same, with the centres
  std::vector<double> inverse_depths;         // of the structure's points
  std::vector<SpaceLine> lines;               // the structure's, world frame
  BundleInertia inertia;
};

// The target as it reads the observation's row; `row` serves for it where the target moves meanwhile.
template <typename Observation>
const CameraFrame& targetFrame(const BundleStructure& structure, const BundleState& state,
                               const Observation& observation, CameraFrame& row) {
  const CameraFrame& target = state.frames[static_cast<std::size_t>(observation.target)];
  if (observation.row < 0) return target;
  row = rowFrame(target, structure.rows[static_cast<std::size_t>(observation.row)]);
  return row;
}

// Where a point's bearing starts from, world frame.
inline Eigen::Vector3d hostCentre(const StructuredPoint& point, const CameraFrame& host) {
  return host.centre + host.world_R_camera * point.host_origin;
}

// Whitened norm that an observation behind its camera counts with, without pulling at anything: enough that no step is
// taken for bringing points there, little enough that a single point does not forbid a step.
constexpr double behind_norm = 100;

// What is needed of an eliminated point to find its depth again.
struct EliminatedPoint {
  Eigen::Vector3d lever;           // z above
  double inverse_depth = 0;        // rho above
  double gradient = 0;             // of the cost, by the inverse depth
  double inverse_information = 0;  // 0: stays where it is
};

// What is needed of an eliminated line to find its change again, which is along its basis, as of movedLine().
struct EliminatedLine {
  LineBasis basis = LineBasis::Zero();
  Eigen::Vector4d gradient = Eigen::Vector4d::Zero();             // of the cost, by the change
  Eigen::Matrix4d inverse_information = Eigen::Matrix4d::Zero();  // 0: stays where it is
};

using Matrix64d = Eigen::Matrix<double, 6, 4>;

struct BundleLinearization {
  double cost = 0;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<Matrix6d> blocks;    // of the reduced system, twists; undamped but for depths and lines
  std::vector<Matrix6d> pairs;     // of the squared difference of a host's and a target's twist, both free
  std::vector<Matrix6d> diagonal;  // of each unknown: its block as it was before depths and lines were eliminated
  Eigen::VectorXd gradient;        // reduced, 6 an unknown
  // Of what is adjusted of inertia, where that is free: with itself, with the twists, and the cost's gradient.
  InertiaMatrix inertia_block = InertiaMatrix::Zero();
  Eigen::Matrix<double, Eigen::Dynamic, 9> inertia_border;
  InertiaVector inertia_gradient = InertiaVector::Zero();
  Eigen::VectorXd camera_gradient;  // before depths and lines were eliminated
  std::vector<EliminatedPoint> points;
  // How depth and camera motion mix, for each observation: d^2 cost / (d sight d inverse depth).
  std::vector<Eigen::Vector3d> mixed;
  std::vector<EliminatedLine> lines;
  std::vector<Matrix64d> line_mixed;  // d^2 cost / (d twist d change), for each viewer of each line
};

// Robust cost (half the sum of Huber's losses, and priors) at a state. `problem`: that the structure was made of.
double bundleCost(const Camera& camera, const BundleProblem& problem, const BundleStructure& structure,
                  const BundleState& state, double huber);

// Normal equations at a state, weights frozen there; depths and lines are damped by `damping` times their own
// information.
// `linearization.origin` is as the caller sets it.
void linearizeBundle(const Camera& camera, const BundleProblem& problem, const BundleStructure& structure,
                     const BundleState& state, double huber, double damping, BundleLinearization& linearization);

// Change of each point's inverse depth that goes with the twists (6 an unknown).
void changeDepths(const BundleStructure& structure, const BundleLinearization& linearization,
                  const Eigen::VectorXd& twists, std::vector<double>& changes);

}  // namespace edgeslam
