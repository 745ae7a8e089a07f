#include "adjustment/bundle_inertia.h"

#include <Eigen/LU>
#include <cmath>

#include "adjustment/index.h"
#include "geometry/tangents.h"

namespace edgeslam {
namespace {

// Whitened, with the derivatives by the twist of each camera, and by what is adjusted of inertia, where asked for.
struct Term {
  Eigen::Vector3d residual;
  std::array<Matrix36d, 3> by_twist;
  double huber_times = inertial_huber_times;
  Eigen::Matrix<double, 3, 9> by_inertia;
};

struct CameraAt {
  Eigen::Quaterniond rotation;
  Eigen::Vector3d centre;
};

// The inverse of SO(3)'s right Jacobian at a rotation vector (Sola et al., A micro Lie theory, 2018, eq. 144).
Eigen::Matrix3d inverseRightJacobian(const Eigen::Vector3d& turn) {
  const double angle = turn.norm();
  const Eigen::Matrix3d cross = skew(turn);
  const double second =
      angle < 1e-4 ? 1.0 / 12 : 1 / (angle * angle) - (1 + std::cos(angle)) / (2 * angle * std::sin(angle));
  return Eigen::Matrix3d::Identity() + 0.5 * cross + second * cross * cross;
}

void evaluate(const BundleInertia& inertia, const BundleTurn& turn, const CameraAt& first, const CameraAt& second,
              Term& term, bool derivatives) {
  const Eigen::Quaterniond measured =
      inertia.is_free ? turn.first_R_second * rotationExp(turn.by_rate_bias * inertia.bias_change.head<3>())
                      : turn.first_R_second;
  const Eigen::Quaterniond error = measured.conjugate() * first.rotation.conjugate() * second.rotation;
  const Eigen::Vector3d error_vector = rotationLog(error.normalized());
  term.residual = turn.whitening * error_vector;
  term.huber_times = turn.huber_times;
  if (!derivatives) return;
  term.by_twist[1].leftCols<3>().setZero();
  term.by_twist[1].rightCols<3>() =
      turn.whitening * inverseRightJacobian(error_vector) * second.rotation.conjugate().toRotationMatrix();
  term.by_twist[0] = -term.by_twist[1];
  if (!inertia.is_free) return;
  term.by_inertia.setZero();
  const Eigen::Matrix3d bias_turn = inverseRightJacobian(turn.by_rate_bias * inertia.bias_change.head<3>()).inverse();
  term.by_inertia.middleCols<3>(3) =
      -turn.whitening * inverseRightJacobian(error_vector).transpose() * bias_turn * turn.by_rate_bias;
}

void evaluate(const BundleInertia& inertia, const BundleWay& way, const CameraAt& first, const CameraAt& second,
              const Eigen::Vector3d& origin, Term& term, bool derivatives) {
  const double metres_a_unit = way.metres_a_unit;
  const Eigen::Vector3d moved = metres_a_unit * (second.centre - first.centre);
  const Eigen::Matrix3d whitening = way.whitening * first.rotation.conjugate().toRotationMatrix();
  term.residual = whitening * moved - way.whitening * way.way;
  term.huber_times = way.huber_times;
  if (!derivatives) return;
  term.by_twist[1].leftCols<3>() = metres_a_unit * whitening;
  term.by_twist[1].rightCols<3>() = -metres_a_unit * whitening * skew(second.centre - origin);
  term.by_twist[0].leftCols<3>() = -term.by_twist[1].leftCols<3>();
  term.by_twist[0].rightCols<3>() = whitening * (metres_a_unit * skew(first.centre - origin) + skew(moved));
  if (!inertia.is_free) return;
  term.by_inertia.setZero();
}

void evaluate(const BundleInertia& inertia, const BundleSpeedChange& change, const std::array<CameraAt, 3>& cameras,
              const Eigen::Vector3d& origin, Term& term, bool derivatives) {
  const double s = inertia.metres_a_unit, t1 = change.seconds[0], t2 = change.seconds[1];
  std::array<Eigen::Vector3d, 3> levers;
  for (std::size_t k = 0; k < 3; ++k) levers[k] = cameras[k].rotation * inertia.camera_t_imu;
  const auto place = [&](std::size_t k) -> Eigen::Vector3d { return s * cameras[k].centre + levers[k]; };
  Eigen::Vector3d first = cameras[0].rotation * change.of_first, second = cameras[1].rotation * change.of_second;
  if (inertia.is_free) {
    first += cameras[0].rotation * (change.first_by_bias * inertia.bias_change);
    second += cameras[1].rotation * (change.second_by_bias * inertia.bias_change);
  }
  // What the first camera sees of the error, so that the whitening is the same however the world is turned.
  const Eigen::Matrix3d whitening = change.whitening * cameras[0].rotation.conjugate().toRotationMatrix();
  const Eigen::Vector3d error =
      (place(2) - place(1)) / t2 - (place(1) - place(0)) / t1 - 0.5 * (t1 + t2) * inertia.gravity - first - second;
  term.residual = whitening * error;
  term.huber_times = inertial_huber_times;
  if (!derivatives) return;
  const std::array<double, 3> weights{1 / t1, -1 / t1 - 1 / t2, 1 / t2};
  for (std::size_t k = 0; k < 3; ++k) {
    Matrix36d& by_twist = term.by_twist[k];
    by_twist.leftCols<3>() = weights[k] * s * Eigen::Matrix3d::Identity();
    by_twist.rightCols<3>() = -weights[k] * skew(s * (cameras[k].centre - origin) + levers[k]);
  }
  term.by_twist[0].rightCols<3>() += skew(first) + skew(error);
  term.by_twist[1].rightCols<3>() += skew(second);
  for (Matrix36d& by_twist : term.by_twist) by_twist = whitening * by_twist;
  if (!inertia.is_free) return;
  term.by_inertia.col(0) =
      s * ((cameras[2].centre - cameras[1].centre) / t2 - (cameras[1].centre - cameras[0].centre) / t1);
  term.by_inertia.middleCols<2>(1) =
      -0.5 * (t1 + t2) * inertia.gravity.norm() * tangentsOf(inertia.gravity.normalized());
  term.by_inertia.rightCols<6>() = -(cameras[0].rotation.toRotationMatrix() * change.first_by_bias) -
                                   cameras[1].rotation.toRotationMatrix() * change.second_by_bias;
  term.by_inertia = (whitening * term.by_inertia).eval();
}

CameraAt cameraAt(const BundleState& state, int camera) {
  return {state.rotations[at(camera)], state.frames[at(camera)].centre};
}

CameraAt cameraAt(const BundleProblem& problem, int camera) {
  const Pose& pose = problem.cameras[at(camera)].world_T_camera;
  return {pose.rotation, pose.translation};
}

template <typename Cameras>
std::array<CameraAt, 3> camerasOf(const BundleSpeedChange& change, const Cameras& cameras) {
  return {cameraAt(cameras, change.cameras[0]), cameraAt(cameras, change.cameras[1]),
          cameraAt(cameras, change.cameras[2])};
}

// Calls function(structured term, evaluated term) for each.
template <typename Function>
void forEachTerm(const BundleProblem& problem, const BundleStructure& structure, const BundleState& state,
                 const Eigen::Vector3d& origin, bool derivatives, const Function& function) {
  Term term;
  for (const StructuredInertia& structured : structure.turns) {
    const BundleTurn& turn = problem.turns[at(structured.index)];
    evaluate(state.inertia, turn, cameraAt(state, turn.first), cameraAt(state, turn.second), term, derivatives);
    function(structured, term);
  }
  for (const StructuredInertia& structured : structure.speed_changes) {
    const BundleSpeedChange& change = problem.speed_changes[at(structured.index)];
    evaluate(state.inertia, change, camerasOf(change, state), origin, term, derivatives);
    function(structured, term);
  }
  for (const StructuredInertia& structured : structure.ways) {
    const BundleWay& way = problem.ways[at(structured.index)];
    evaluate(state.inertia, way, cameraAt(state, way.first), cameraAt(state, way.second), origin, term, derivatives);
    function(structured, term);
  }
}

// What is known of the scale and the biases before.
InertiaVector priorInformation(const BundleInertia& inertia) {
  InertiaVector information = InertiaVector::Zero();
  const auto of = [](double sigma) { return sigma > 0 ? 1 / (sigma * sigma) : 0; };
  information(0) = of(inertia.told_scale_sigma);
  information.segment<3>(3).setConstant(of(inertia.rate_bias_sigma));
  information.tail<3>().setConstant(of(inertia.force_bias_sigma));
  return information;
}

// How far the scale's logarithm is from what it was told.
double scaleChange(const BundleInertia& inertia) {
  return inertia.told_scale_sigma > 0 ? std::log(inertia.metres_a_unit / inertia.told_metres_a_unit) : 0;
}

double priorCost(const BundleInertia& inertia) {
  if (!inertia.is_free) return 0;
  const InertiaVector information = priorInformation(inertia);
  const double change = scaleChange(inertia);
  return 0.5 * inertia.bias_change.dot(information.tail<6>().cwiseProduct(inertia.bias_change)) +
         0.5 * information(0) * change * change;
}

void addPrior(const BundleInertia& inertia, BundleLinearization& linearization) {
  const InertiaVector information = priorInformation(inertia);
  linearization.inertia_block.diagonal() += information;
  linearization.inertia_gradient(0) += information(0) * scaleChange(inertia);
  linearization.inertia_gradient.tail<6>() += information.tail<6>().cwiseProduct(inertia.bias_change);
}

void addToInertia(const StructuredInertia& structured, const Term& term, double weight,
                  BundleLinearization& linearization) {
  const Eigen::Matrix<double, 9, 3> weighted = weight * term.by_inertia.transpose();
  linearization.inertia_gradient += weighted * term.residual;
  linearization.inertia_block += weighted * term.by_inertia;
  for (int row = 0; row < 3; ++row) {
    const int unknown = structured.unknowns[at(row)];
    if (unknown < 0) continue;
    linearization.inertia_border.middleRows<6>(6 * unknown) += (weighted * term.by_twist[at(row)]).transpose();
  }
}

// The scale of map and unit together is nobody's: that of the map is held, which takes nothing from any other change.
void holdScale(const BundleProblem& problem, const BundleStructure& structure, const BundleState& state,
               BundleLinearization& linearization) {
  constexpr double held = 1e-3;  // of the distance
  if (problem.scale_camera < 1) return;
  const int unknown = structure.unknown_of_camera[at(problem.scale_camera)];
  if (unknown < 0) return;
  const Eigen::Vector3d centre = state.frames[at(problem.scale_camera)].centre;
  const Eigen::Vector3d way = centre - state.frames[0].centre;
  const double squared = way.squaredNorm();
  if (!(squared > 0)) return;
  Vector6d by_twist;
  by_twist << way / squared, (centre - linearization.origin).cross(way) / squared;
  linearization.diagonal[at(unknown)] += by_twist * by_twist.transpose() / (held * held);
}

void add(const StructuredInertia& structured, const Term& term, double weight, BundleLinearization& linearization) {
  for (int row = 0; row < 3; ++row) {
    const int unknown = structured.unknowns[at(row)];
    if (unknown < 0) continue;
    const Eigen::Matrix<double, 6, 3> weighted = weight * term.by_twist[at(row)].transpose();
    linearization.camera_gradient.segment<6>(6 * unknown) += weighted * term.residual;
    linearization.diagonal[at(unknown)] += weighted * term.by_twist[at(row)];
    for (int column = 0; column < row; ++column) {
      const int other = structured.unknowns[at(column)];
      if (other < 0) continue;
      Matrix6d block = weighted * term.by_twist[at(column)];
      if (other > unknown) block.transposeInPlace();
      linearization.blocks[at(structured.blocks[at(blockOfPair(row, column))])] += block;
    }
  }
}

}  // namespace

double inertialCost(const BundleProblem& problem, double huber) {
  Term term;
  double cost = 0;
  const auto count = [&] { cost += 0.5 * huberLoss(term.residual.squaredNorm(), term.huber_times * huber); };
  for (const BundleTurn& turn : problem.turns) {
    if (!usable(turn)) continue;
    evaluate(problem.inertia, turn, cameraAt(problem, turn.first), cameraAt(problem, turn.second), term, false);
    count();
  }
  for (const BundleSpeedChange& change : problem.speed_changes) {
    if (!usable(change)) continue;
    evaluate(problem.inertia, change, camerasOf(change, problem), Eigen::Vector3d::Zero(), term, false);
    count();
  }
  for (const BundleWay& way : problem.ways) {
    if (!usable(way)) continue;
    evaluate(problem.inertia, way, cameraAt(problem, way.first), cameraAt(problem, way.second), Eigen::Vector3d::Zero(),
             term, false);
    count();
  }
  return cost + priorCost(problem.inertia);
}

double inertialCost(const BundleProblem& problem, const BundleStructure& structure, const BundleState& state,
                    double huber) {
  double cost = 0;
  forEachTerm(problem, structure, state, Eigen::Vector3d::Zero(), false,
              [&](const StructuredInertia&, const Term& term) {
                cost += 0.5 * huberLoss(term.residual.squaredNorm(), term.huber_times * huber);
              });
  return cost + priorCost(state.inertia);
}

void linearizeInertia(const BundleProblem& problem, const BundleStructure& structure, const BundleState& state,
                      double huber, BundleLinearization& linearization) {
  const bool is_free = state.inertia.is_free;
  if (is_free) {
    linearization.inertia_block.setZero();
    linearization.inertia_gradient.setZero();
    linearization.inertia_border.setZero(linearization.camera_gradient.size(), 9);
    linearization.cost += priorCost(state.inertia);
    addPrior(state.inertia, linearization);
    holdScale(problem, structure, state, linearization);
  }
  forEachTerm(problem, structure, state, linearization.origin, true,
              [&](const StructuredInertia& structured, const Term& term) {
                linearization.cost += 0.5 * huberLoss(term.residual.squaredNorm(), term.huber_times * huber);
                const double weight = huberWeight(term.residual.norm(), term.huber_times * huber);
                add(structured, term, weight, linearization);
                if (is_free) addToInertia(structured, term, weight, linearization);
              });
}

BundleInertia movedInertia(const BundleInertia& inertia, const InertiaVector& change) {
  BundleInertia moved = inertia;
  moved.metres_a_unit *= std::exp(change(0));
  const double length = inertia.gravity.norm();
  moved.gravity =
      length *
      (inertia.gravity + length * (tangentsOf(inertia.gravity.normalized()) * change.segment<2>(1))).normalized();
  moved.bias_change += change.tail<6>();
  return moved;
}

}  // namespace edgeslam
