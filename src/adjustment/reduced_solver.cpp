#include "adjustment/reduced_solver.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "adjustment/damping.h"
#include "adjustment/index.h"

namespace edgeslam {
namespace {

// With d from the origin to the centre c, the twist of a step [c'; w] is v = c' + d x w. These bring a block from
// twists to such steps.
void toStepsOfColumn(const Eigen::Vector3d& lever, Matrix6d& block) {
  block.rightCols<3>().noalias() += block.leftCols<3>() * skew(lever);
}
void toStepsOfRow(const Eigen::Vector3d& lever, Matrix6d& block) {
  block.bottomRows<3>().noalias() -= skew(lever) * block.topRows<3>();
}

}  // namespace

void ReducedSolver::prepare(const BundleStructure& structure) {
  const auto size = static_cast<Eigen::Index>(6 * structure.camera_of_unknown.size());
  if (structure.dense) {
    dense_.resize(size, size);
    return;
  }
  sparse_.resize(size, size);
  sparse_.setZero();
  std::vector<int> entries(at(static_cast<int>(size)), 0);
  for (const BlockPlace& place : structure.places) {
    for (int j = 0; j < 6; ++j) entries[at(6 * place.column + j)] += place.row == place.column ? 6 - j : 6;
  }
  sparse_.reserve(entries);
  for (const BlockPlace& place : structure.places) {
    for (int j = 0; j < 6; ++j) {
      for (int i = place.row == place.column ? j : 0; i < 6; ++i)
        sparse_.insert(6 * place.row + i, 6 * place.column + j) = 0;
    }
  }
  sparse_.makeCompressed();
  factor_.analyzePattern(sparse_);
}

bool ReducedSolver::solve(const BundleStructure& structure, const BundleState& state,
                          const BundleLinearization& linearization, double damping, CameraStep& step) {
  const std::size_t unknowns = structure.camera_of_unknown.size();
  levers_.resize(unknowns);
  step.changes.resize(linearization.gradient.size());
  for (std::size_t k = 0; k < unknowns; ++k) {
    levers_[k] = state.frames[at(structure.camera_of_unknown[k])].centre - linearization.origin;
    const auto gradient = linearization.gradient.segment<6>(static_cast<Eigen::Index>(6 * k));
    step.changes.segment<3>(static_cast<Eigen::Index>(6 * k)) = -gradient.head<3>();
    step.changes.segment<3>(static_cast<Eigen::Index>(6 * k + 3)) =
        levers_[k].cross(Eigen::Vector3d(gradient.head<3>())) - gradient.tail<3>();
  }
  border_.resize(0, 9);
  if (state.inertia.is_free) {
    border_ = linearization.inertia_border;
    for (std::size_t k = 0; k < unknowns; ++k) {
      const auto row = static_cast<Eigen::Index>(6 * k);
      border_.middleRows<3>(row + 3) -= (skew(levers_[k]) * border_.middleRows<3>(row)).eval();
    }
  }
  const Eigen::Matrix<double, Eigen::Dynamic, 9> border = border_;
  if (structure.dense) {
    if (!solveDense(structure, linearization, damping, step.changes)) return false;
  } else {
    fillSparse(structure, linearization, damping);
    if (!solveSparse(step.changes)) return false;
  }
  step.inertia.setZero();
  if (state.inertia.is_free && !solveInertia(linearization, border, damping, step)) return false;
  step.twists = step.changes;
  for (std::size_t k = 0; k < unknowns; ++k) {
    const Eigen::Vector3d turn = step.changes.segment<3>(static_cast<Eigen::Index>(6 * k + 3));
    step.twists.segment<3>(static_cast<Eigen::Index>(6 * k)) += levers_[k].cross(turn);
  }
  return step.changes.allFinite();
}

bool ReducedSolver::solveInertia(const BundleLinearization& linearization,
                                 const Eigen::Matrix<double, Eigen::Dynamic, 9>& border, double damping,
                                 CameraStep& step) {
  InertiaMatrix block = linearization.inertia_block;
  block.diagonal() += damping * block.diagonal().cwiseMax(least_information);
  block -= border.transpose() * border_;
  const Eigen::LLT<InertiaMatrix> factor(block);
  if (factor.info() != Eigen::Success) return false;
  step.inertia = factor.solve(-linearization.inertia_gradient - border.transpose() * step.changes);
  step.changes -= border_ * step.inertia;
  inertia_covariance_ = factor.solve(InertiaMatrix::Identity());
  return step.inertia.allFinite();
}

// A block of the system for centre and turn.
Matrix6d ReducedSolver::damped(const BlockPlace& place, const Matrix6d& block, const BundleLinearization& linearization,
                               double damping) const {
  Matrix6d changed = block;
  toStepsOfColumn(levers_[at(place.column)], changed);
  toStepsOfRow(levers_[at(place.row)], changed);
  if (place.row != place.column) return changed;
  Matrix6d own = linearization.diagonal[at(place.row)];
  toStepsOfColumn(levers_[at(place.row)], own);
  toStepsOfRow(levers_[at(place.row)], own);
  changed.diagonal() += damping * own.diagonal().cwiseMax(least_information);
  return changed;
}

bool ReducedSolver::solveDense(const BundleStructure& structure, const BundleLinearization& linearization,
                               double damping, Eigen::VectorXd& solution) {
  for (std::size_t b = 0; b < structure.places.size(); ++b) {
    const BlockPlace place = structure.places[b];
    dense_.block<6, 6>(6 * place.row, 6 * place.column) =
        damped(place, linearization.blocks[b], linearization, damping);
  }
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(dense_);
  if (factor.info() != Eigen::Success) return false;
  factor.solveInPlace(solution);
  if (border_.rows() > 0) factor.solveInPlace(border_);
  return true;
}

bool ReducedSolver::solveSparse(Eigen::VectorXd& solution) {
  factor_.factorize(sparse_);
  if (factor_.info() != Eigen::Success) return false;
  solution = factor_.solve(solution).eval();
  if (border_.rows() > 0) border_ = factor_.solve(Eigen::MatrixXd(border_));
  return true;
}

// Blocks stand by column, then row, beginning with the diagonal's: the order of the values.
void ReducedSolver::fillSparse(const BundleStructure& structure, const BundleLinearization& linearization,
                               double damping) {
  double* value = sparse_.valuePtr();
  std::size_t first = 0;
  while (first < structure.places.size()) {
    const int column = structure.places[first].column;
    std::size_t end = first;
    column_.clear();
    for (; end < structure.places.size() && structure.places[end].column == column; ++end) {
      column_.push_back(damped(structure.places[end], linearization.blocks[end], linearization, damping));
    }
    for (int j = 0; j < 6; ++j) {
      for (std::size_t b = 0; b < column_.size(); ++b) {
        for (int i = b == 0 ? j : 0; i < 6; ++i) *value++ = column_[b](i, j);
      }
    }
    first = end;
  }
}

}  // namespace edgeslam
