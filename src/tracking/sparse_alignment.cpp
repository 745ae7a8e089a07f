#include "tracking/sparse_alignment.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "flow/patch_alignment.h"

namespace edgeslam {
namespace {

constexpr int side = 5;  // of a patch [px of the level]
constexpr int area = side * side;

struct Patch {
  Eigen::Vector3d position;  // in the first camera's frame
  PatchTemplate appearance;
  // d level pixel / d [translation; rotation] of the point in the first frame, and what it makes of the patch's tensor.
  Eigen::Matrix<double, 2, 6> pixel_by_motion;
  Matrix6d information;
};

using Patches = std::pmr::vector<Patch>;

// Of every `stride`-th point.
void makePatches(const Camera& camera, const cv::Mat& image, int level, const HiddenLevels& hidden,
                 const AlignmentPoints& points, std::size_t stride, Patches& patches) {
  const double scale = 1.0 / (1 << level);
  patches.clear();
  for (std::size_t i = 0; i < points.size(); i += stride) {
    const AlignmentPoint& point = points[i];
    const Eigen::Vector2f pixel = point.pixel * static_cast<float>(scale);
    if (isHiddenAt(hidden, static_cast<std::size_t>(level), pixel.x(), pixel.y())) continue;
    Patch& patch = patches.emplace_back();
    if (!makeTemplate(image, pixel, Eigen::Matrix2f::Identity(), side, patch.appearance)) {
      patches.pop_back();
      continue;
    }
    patch.position = point.position;
    Eigen::Matrix<double, 2, 3> jacobian;
    project(camera, point.position, &jacobian);
    patch.pixel_by_motion << jacobian * scale, -jacobian * skew(point.position) * scale;
    const Eigen::Matrix2d tensor = patch.appearance.normal_matrix.topLeftCorner<2, 2>().cast<double>();
    patch.information.noalias() = patch.pixel_by_motion.transpose() * (tensor * patch.pixel_by_motion);
  }
}

struct PatchComparisons {
  int patches = 0;
  double cost = 0;  // robust, a patch
  Matrix6d normal_matrix = Matrix6d::Zero();
  Vector6d right = Vector6d::Zero();
};

PatchComparisons compare(const Camera& camera, const Patches& patches, const cv::Mat& image, int level,
                         const HiddenLevels& hidden, const Pose& to_T_from, double huber) {
  const double scale = 1.0 / (1 << level);
  const Eigen::Matrix3d rotation = to_T_from.rotation.toRotationMatrix();
  PatchComparisons sum;
  for (const Patch& patch : patches) {
    const Eigen::Vector3d moved = rotation * patch.position + to_T_from.translation;
    if (moved.z() < 0.05 * patch.position.z()) continue;
    const Eigen::Vector2d pixel = project(camera, moved) * scale;
    if (!(pixel.x() > 0 && pixel.y() > 0 && pixel.x() < image.cols - 1 && pixel.y() < image.rows - 1)) continue;
    const Eigen::Vector2f there = pixel.cast<float>();
    if (isHiddenAt(hidden, static_cast<std::size_t>(level), there.x(), there.y())) continue;
    const PatchDifference difference = differenceAt(patch.appearance, image, there);
    const double root = std::sqrt(difference.squares / area);
    const double weight = root > huber ? huber / root : 1.0;
    sum.cost += root > huber ? huber * (2 * root - huber) : root * root;
    sum.normal_matrix += weight * patch.information;
    sum.right.noalias() += patch.pixel_by_motion.transpose() * (weight * difference.along_gradient.cast<double>());
    ++sum.patches;
  }
  if (sum.patches > 0) sum.cost /= sum.patches;
  return sum;
}

}  // namespace

Pose alignSparsely(const Camera& camera, const ImagePyramid& from, const ImagePyramid& to,
                   const AlignmentPoints& points, const Pose& first_start, const Pose& second_start,
                   const SparseAlignmentOptions& options, std::pmr::memory_resource* memory,
                   const HiddenLevels& hidden) {
  Pose to_T_from = first_start;
  bool compared = false;
  const auto most = static_cast<std::size_t>(options.most_points);
  const std::size_t stride = std::max<std::size_t>(1, (points.size() + most - 1) / most);
  Patches patches(memory);
  patches.reserve(points.size() / stride + 1);
  for (int level = options.coarsest_level; level >= options.finest_level; --level) {
    const auto index = static_cast<std::size_t>(level);
    if (index >= from.levels.size() || index >= to.levels.size()) continue;
    makePatches(camera, from.levels[index], level, hidden, points, stride, patches);
    PatchComparisons best = compare(camera, patches, to.levels[index], level, hidden, to_T_from, options.huber);
    if (!compared) {
      const PatchComparisons other =
          compare(camera, patches, to.levels[index], level, hidden, second_start, options.huber);
      if (other.patches >= 10 && (best.patches < 10 || other.cost < best.cost)) {
        best = other;
        to_T_from = second_start;
      }
      if (best.patches < 10) return first_start;
      compared = true;
    }
    for (int iteration = 0; iteration < options.iterations; ++iteration) {
      Matrix6d damped = best.normal_matrix;
      damped.diagonal() *= 1.0 + 1e-4;
      damped.diagonal().array() += 1e-6;
      const Vector6d step = damped.ldlt().solve(best.right);
      if (!step.allFinite()) break;
      // The template moved by `step` matches the image at the present pose, so the pose takes the inverse of it.
      const Pose next_pose = to_T_from * retract(Pose(), step).inverse();
      const PatchComparisons next = compare(camera, patches, to.levels[index], level, hidden, next_pose, options.huber);
      if (next.patches < 10 || 3 * next.patches < 2 * best.patches || next.cost >= best.cost) break;
      const double gain = best.cost - next.cost;
      to_T_from = next_pose;
      best = next;
      if (gain < 1e-3 * best.cost) break;
    }
  }
  return to_T_from;
}

}  // namespace edgeslam
