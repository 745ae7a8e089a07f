#include "adjustment/bundle_minimization.h"

#include <algorithm>
#include <cmath>

#include "adjustment/bundle_inertia.h"
#include "adjustment/bundle_lines.h"
#include "adjustment/index.h"

namespace edgeslam {
namespace {

constexpr int most_dense_cameras = 30;
constexpr double first_damping = 1e-4;
constexpr double least_damping = 1e-9;
constexpr double best_factor = 1.0 / 3;  // that the damping is multiplied by after a step as good as expected
constexpr double most_damping = 1e8;
constexpr double converged_change = 1e-6;  // of the cost; outliers inflate the cost that this is relative to

void readState(const BundleProblem& problem, const BundleStructure& structure, BundleState& state) {
  state.rotations.clear();
  state.frames.clear();
  for (const BundleCamera& c : problem.cameras) {
    state.rotations.push_back(c.world_T_camera.rotation);
    state.frames.push_back(cameraFrame(c.world_T_camera));
  }
  state.inverse_depths.clear();
  for (const StructuredPoint& p : structure.points)
    state.inverse_depths.push_back(problem.points[at(p.index)].inverse_depth);
  state.lines.clear();
  for (const StructuredLine& line : structure.lines) state.lines.push_back(problem.lines[at(line.index)].line);
  state.inertia = problem.inertia;
}

Eigen::Vector3d meanCentre(const BundleState& state) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const CameraFrame& frame : state.frames) sum += frame.centre;
  return sum / static_cast<double>(state.frames.size());
}

void moveState(const BundleWorkspace& workspace, BundleState& moved) {
  moved = workspace.state;
  for (std::size_t k = 0; k < workspace.structure.camera_of_unknown.size(); ++k) {
    const Vector6d change = workspace.step.changes.segment<6>(static_cast<Eigen::Index>(6 * k));
    const std::size_t c = at(workspace.structure.camera_of_unknown[k]);
    moved.rotations[c] = (rotationExp(change.tail<3>()) * moved.rotations[c]).normalized();
    moved.frames[c] = {moved.rotations[c].toRotationMatrix(), moved.frames[c].centre + change.head<3>()};
  }
  for (std::size_t i = 0; i < moved.inverse_depths.size(); ++i) moved.inverse_depths[i] += workspace.depth_changes[i];
  for (std::size_t i = 0; i < moved.lines.size(); ++i)
    moved.lines[i] = movedLine(moved.lines[i], workspace.line_changes[i]);
  if (moved.inertia.is_free) moved.inertia = movedInertia(moved.inertia, workspace.step.inertia);
}

// What the step takes off the cost if all is linear: half of it is undone by the curvature.
double expectedGain(const BundleWorkspace& workspace) {
  double descent = -workspace.linearization.camera_gradient.dot(workspace.step.twists);
  for (std::size_t i = 0; i < workspace.depth_changes.size(); ++i)
    descent -= workspace.linearization.points[i].gradient * workspace.depth_changes[i];
  for (std::size_t i = 0; i < workspace.line_changes.size(); ++i)
    descent -= workspace.linearization.lines[i].gradient.dot(workspace.line_changes[i]);
  if (workspace.state.inertia.is_free) descent -= workspace.linearization.inertia_gradient.dot(workspace.step.inertia);
  return 0.5 * descent;
}

bool computeStep(double damping, BundleWorkspace& workspace) {
  if (!workspace.solver.solve(workspace.structure, workspace.state, workspace.linearization, damping, workspace.step))
    return false;
  changeDepths(workspace.structure, workspace.linearization, workspace.step.twists, workspace.depth_changes);
  changeLines(workspace.structure, workspace.linearization, workspace.step.twists, workspace.line_changes);
  return true;
}

// Nielsen's rule (Madsen, Nielsen, Tingleff, Methods for Non-Linear Least Squares Problems, 2004, section 3.2): what
// the damping is multiplied by after a step, from what it gained against what was expected.
double dampingFactor(double gain, double expected) {
  const double doubt = 2 * gain / expected - 1;
  return std::max(best_factor, 1 - doubt * doubt * doubt);
}

}  // namespace

int minimizeBundle(const Camera& camera, const BundleProblem& problem, const BundleOptions& options,
                   const std::atomic<bool>* interrupted, BundleWorkspace& workspace) {
  structureBundle(camera, problem, most_dense_cameras, workspace.structure);
  if (workspace.structure.points.empty() && workspace.structure.lines.empty()) return -1;
  workspace.solver.prepare(workspace.structure);
  readState(problem, workspace.structure, workspace.state);
  workspace.linearization.origin = meanCentre(workspace.state);

  const auto linearizeAt = [&](const BundleState& state, double damping) {
    linearizeBundle(camera, problem, workspace.structure, state, options.huber, damping, workspace.linearization);
    return workspace.linearization.cost;
  };
  double damping = first_damping, refusal_factor = 2;
  double cost = linearizeAt(workspace.state, damping);
  if (!std::isfinite(cost)) return -1;
  bool ever_solved = false;
  int iteration = 0;
  while (iteration < options.iterations) {
    if (interrupted && interrupted->load(std::memory_order_relaxed)) return -1;
    ++iteration;
    const bool solved = computeStep(damping, workspace);
    ever_solved |= solved;
    const double expected = solved ? expectedGain(workspace) : 0;
    const bool last = iteration == options.iterations || (solved && expected < converged_change * cost);
    // Most steps are good, so that the next equations are made at once, with the damping that follows a good step.
    const double hoped_damping = std::max(least_damping, best_factor * damping);
    double new_cost = cost;
    if (solved) {
      moveState(workspace, workspace.candidate);
      new_cost = last ? bundleCost(camera, problem, workspace.structure, workspace.candidate, options.huber)
                      : linearizeAt(workspace.candidate, hoped_damping);
    }
    const double gain = cost - new_cost;
    if (gain > 0) {
      std::swap(workspace.state, workspace.candidate);
      cost = new_cost;
      if (last || gain < converged_change * cost) break;
      const double factor = dampingFactor(gain, expected);
      damping = std::clamp(factor * damping, least_damping, most_damping);
      refusal_factor = 2;
      if (factor > 1) linearizeAt(workspace.state, damping);  // else depths' and lines' damping does not matter
    } else {
      damping *= refusal_factor;
      refusal_factor *= 2;
      if (last || damping > most_damping) break;
      linearizeAt(workspace.state, damping);
    }
  }
  return ever_solved || options.iterations == 0 ? iteration : -1;
}

}  // namespace edgeslam
