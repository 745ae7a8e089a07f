// Solves the damped system in the cameras' poses that is left when a bundle adjustment's depths and lines are
// eliminated.
#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <vector>

#include "adjustment/bundle_linearization.h"

namespace edgeslam {

// A step of the cameras: of each unknown the change of its centre and its turn [rad], world axes, [centre; turn]; and
// the same as twists.
struct CameraStep {
  Eigen::VectorXd changes;
  Eigen::VectorXd twists;
};

class ReducedSolver {
 public:
  // To be called where the structure is new.
  void prepare(const BundleStructure& structure);

  // Levenberg-Marquardt's step: each unknown is damped by `damping` times its own diagonal entry before elimination,
  // centre and turn as in CameraStep. False: singular to working precision.
  bool solve(const BundleStructure& structure, const BundleState& state, const BundleLinearization& linearization,
             double damping, CameraStep& step);

 private:
  bool solveDense(const BundleStructure& structure, Eigen::VectorXd& solution);
  bool solveSparse(Eigen::VectorXd& solution);
  void fillSparse(const BundleStructure& structure);

  std::vector<Eigen::Vector3d> levers_;  // of each unknown's camera: from the twists' origin to its centre
  std::vector<Matrix6d> blocks_;         // damped, for centre and turn
  Eigen::MatrixXd dense_;
  Eigen::SparseMatrix<double> sparse_;  // lower triangle
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Lower> factor_;
};

}  // namespace edgeslam
