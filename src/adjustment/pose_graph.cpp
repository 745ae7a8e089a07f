#include "adjustment/pose_graph.h"

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace edgeslam {
namespace {

// A node as Ceres sees it: rotation vector relative to where it started, along the node's turn axes; translation;
// logarithm of the scale relative to where it started. Seven numbers for seven unknowns, or fewer where some are kept.
using NodeParameters = std::array<double, 7>;

template <class T>
using Vector3 = Eigen::Matrix<T, 3, 1>;
template <class T>
using Quaternion = Eigen::Quaternion<T>;

struct NodeStart {
  Similarity world_S_node;
  Eigen::Matrix3d turn_axes;  // columns, in the node's frame; the last one points up where that is kept
};

Eigen::Matrix3d turnAxes(const PoseGraph& graph, const PoseGraphNode& node) {
  if (!graph.up) return Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d level = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), *graph.up).matrix();
  return node.world_S_node.rotation.conjugate() * level;
}

NodeStart startOf(const PoseGraph& graph, int node) {
  const PoseGraphNode& its = graph.nodes[static_cast<std::size_t>(node)];
  return {its.world_S_node, turnAxes(graph, its)};
}

template <class T>
Quaternion<T> rotationOf(const NodeStart& start, const T* parameters) {
  const Vector3<T> turn = start.turn_axes.cast<T>() * Vector3<T>(parameters[0], parameters[1], parameters[2]);
  T step[4];
  ceres::AngleAxisToQuaternion(turn.data(), step);
  return start.world_S_node.rotation.cast<T>() * Quaternion<T>(step[0], step[1], step[2], step[3]);
}

// Error of an edge: from_S_to (measured), inverted, times from_S_to (of the nodes), as seven numbers.
struct EdgeCost {
  EdgeCost(const PoseGraph& graph, const PoseGraphEdge& edge)
      : from(startOf(graph, edge.from)),
        to(startOf(graph, edge.to)),
        to_S_from(edge.from_S_to.inverse()),
        weight(edge.weight),
        length(graph.length) {}

  template <class T>
  bool operator()(const T* from_parameters, const T* to_parameters, T* residuals) const {
    const Quaternion<T> world_R_from = rotationOf(from, from_parameters);
    const Quaternion<T> world_R_to = rotationOf(to, to_parameters);
    const Vector3<T> from_t(from_parameters[3], from_parameters[4], from_parameters[5]);
    const Vector3<T> to_t(to_parameters[3], to_parameters[4], to_parameters[5]);
    const T from_log_scale = T(std::log(from.world_S_node.scale)) + from_parameters[6];
    const T to_log_scale = T(std::log(to.world_S_node.scale)) + to_parameters[6];

    const Quaternion<T> from_R_world = world_R_from.conjugate();
    const Quaternion<T> from_R_to = from_R_world * world_R_to;
    const Vector3<T> from_t_to = (from_R_world * (to_t - from_t)) * exp(-from_log_scale);
    const Quaternion<T> measured = to_S_from.rotation.cast<T>();
    const Quaternion<T> turn = measured * from_R_to;
    const Vector3<T> shift = T(to_S_from.scale) * (measured * from_t_to) + to_S_from.translation.cast<T>();

    const T turn_wxyz[4] = {turn.w(), turn.x(), turn.y(), turn.z()};
    ceres::QuaternionToAngleAxis(turn_wxyz, residuals);
    for (int i = 0; i < 3; ++i) residuals[3 + i] = shift[i] / T(length);
    residuals[6] = T(std::log(to_S_from.scale)) + to_log_scale - from_log_scale;
    for (int i = 0; i < 7; ++i) residuals[i] *= T(weight);
    return true;
  }

  NodeStart from, to;
  Similarity to_S_from;  // measured
  double weight, length;
};

bool isFiniteSimilarity(const Similarity& similarity) {
  return std::isfinite(similarity.scale) && similarity.scale > 0 && similarity.rotation.coeffs().allFinite() &&
         similarity.translation.allFinite();
}

bool wellPosed(const PoseGraph& graph) {
  const int nodes = static_cast<int>(graph.nodes.size());
  if (!(graph.length > 0 && std::isfinite(graph.length))) return false;
  if (graph.up && !(std::abs(graph.up->norm() - 1) < 1e-6)) return false;
  bool any_fixed = false;
  for (const PoseGraphNode& node : graph.nodes) {
    if (!isFiniteSimilarity(node.world_S_node)) return false;
    any_fixed = any_fixed || node.fixed;
  }
  for (const PoseGraphEdge& edge : graph.edges) {
    if (edge.from < 0 || edge.from >= nodes || edge.to < 0 || edge.to >= nodes || edge.from == edge.to) return false;
    if (!isFiniteSimilarity(edge.from_S_to) || !(edge.weight > 0 && std::isfinite(edge.weight))) return false;
  }
  return any_fixed && !graph.edges.empty();
}

Similarity similarityOf(const NodeStart& start, const NodeParameters& parameters) {
  const Eigen::Vector3d turn = start.turn_axes * Eigen::Vector3d(parameters[0], parameters[1], parameters[2]);
  return {start.world_S_node.scale * std::exp(parameters[6]),
          (start.world_S_node.rotation * rotationExp(turn)).normalized(),
          {parameters[3], parameters[4], parameters[5]}};
}

// Which of a node's numbers stay as they are.
std::vector<int> keptNumbers(const PoseGraph& graph) {
  std::vector<int> kept;
  if (graph.up) kept = {0, 1};
  if (graph.keeps_scale) kept.push_back(6);
  return kept;
}

}  // namespace

PoseGraphResult optimisePoseGraph(PoseGraph& graph, int iterations) {
  PoseGraphResult result;
  if (!wellPosed(graph)) return result;
  std::vector<NodeParameters> parameters;
  for (const PoseGraphNode& node : graph.nodes) {
    const Eigen::Vector3d& t = node.world_S_node.translation;
    parameters.push_back({0, 0, 0, t.x(), t.y(), t.z(), 0});
  }
  ceres::Problem problem;
  for (const PoseGraphEdge& edge : graph.edges) {
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<EdgeCost, 7, 7, 7>(new EdgeCost(graph, edge)), nullptr,
                             parameters[static_cast<std::size_t>(edge.from)].data(),
                             parameters[static_cast<std::size_t>(edge.to)].data());
  }
  const std::vector<int> kept = keptNumbers(graph);
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    if (!problem.HasParameterBlock(parameters[i].data())) continue;
    if (graph.nodes[i].fixed) {
      problem.SetParameterBlockConstant(parameters[i].data());
    } else if (!kept.empty()) {
      problem.SetManifold(parameters[i].data(), new ceres::SubsetManifold(7, kept));
    }
  }
  ceres::Solver::Options options;
  options.max_num_iterations = iterations;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.num_threads = 1;
  options.function_tolerance = 1e-8;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  result.initial_cost = summary.initial_cost;
  result.final_cost = summary.final_cost;
  result.iterations = static_cast<int>(summary.iterations.size()) - 1;

  std::vector<Similarity> optimised;
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    optimised.push_back(similarityOf(startOf(graph, static_cast<int>(i)), parameters[i]));
  }
  if (!summary.IsSolutionUsable() || !std::all_of(optimised.begin(), optimised.end(), isFiniteSimilarity))
    return result;
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    if (!graph.nodes[i].fixed) graph.nodes[i].world_S_node = optimised[i];
  }
  result.usable = true;
  return result;
}

}  // namespace edgeslam
