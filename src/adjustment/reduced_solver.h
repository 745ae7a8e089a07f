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
  InertiaVector inertia = InertiaVector::Zero();  // the change of what is adjusted of inertia
};

class ReducedSolver {
 public:
  // To be called where the structure is new.
  void prepare(const BundleStructure& structure);

  // Levenberg-Marquardt's step: each unknown is damped by `damping` times its own diagonal entry before elimination,
  // centre and turn as in CameraStep. False: singular to working precision.
  bool solve(const BundleStructure& structure, const BundleState& state, const BundleLinearization& linearization,
             double damping, CameraStep& step);

  // Of the last solve(), where inertia was free: the covariance of its unknowns, all else free.
  const InertiaMatrix& inertiaCovariance() const { return inertia_covariance_; }

 private:
  // Where inertia is free: its unknowns are eliminated last, by what they share with the cameras.
  bool solveInertia(const BundleLinearization& linearization, const Eigen::Matrix<double, Eigen::Dynamic, 9>& border,
                    double damping, CameraStep& step);
  bool solveDense(const BundleStructure& structure, const BundleLinearization& linearization, double damping,
                  Eigen::VectorXd& solution);
  bool solveSparse(Eigen::VectorXd& solution);
  void fillSparse(const BundleStructure& structure, const BundleLinearization& linearization, double damping);
  Matrix6d damped(const BlockPlace& place, const Matrix6d& block, const BundleLinearization& linearization,
                  double damping) const;

  std::vector<Eigen::Vector3d> levers_;  // of each unknown's camera: from the twists' origin to its centre
  std::vector<Matrix6d> column_;         // damped, for centre and turn: the blocks of one unknown
  Eigen::MatrixXd dense_;
  Eigen::Matrix<double, Eigen::Dynamic, 9> border_;  // inertia's with the steps, and then solved for
  InertiaMatrix inertia_covariance_ = InertiaMatrix::Zero();
  Eigen::SparseMatrix<double> sparse_;  // lower triangle
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Lower> factor_;
};

}  // namespace edgeslam
