#include "tracking/sparse_alignment.h"

#include <Eigen/Cholesky>
#include <array>
#include <cmath>

namespace edgeslam {
namespace {

constexpr int side = 5;  // of a patch [px of the level]
constexpr int area = side * side;

struct Patch {
  Eigen::Vector3d position;                        // in the first camera's frame
  std::array<float, area> grey;                    // less the patch's mean
  std::array<float, area> gradient_x, gradient_y;  // likewise
  Eigen::Matrix<double, 2, 6>
      pixel_by_motion;  // d level pixel / d [translation; rotation] of the point in the first frame
};

bool sample(const cv::Mat& image, double x, double y, int width, float* out) {
  const int radius = width / 2;
  const double left = x - radius, top = y - radius;
  if (!(left >= -16 && top >= -16 && left + width < image.cols + 15 && top + width < image.rows + 15)) return false;
  const double left_floor = std::floor(left), top_floor = std::floor(top);
  const auto a = static_cast<float>(left - left_floor), b = static_cast<float>(top - top_floor);
  const auto step = static_cast<std::ptrdiff_t>(image.step[0]);
  const unsigned char* row =
      image.data + static_cast<std::ptrdiff_t>(top_floor) * step + static_cast<std::ptrdiff_t>(left_floor);
  for (int v = 0; v < width; ++v, row += step) {
    for (int u = 0; u < width; ++u) {
      *out++ = (1 - b) * ((1 - a) * static_cast<float>(row[u]) + a * static_cast<float>(row[u + 1])) +
               b * ((1 - a) * static_cast<float>(row[u + step]) + a * static_cast<float>(row[u + step + 1]));
    }
  }
  return true;
}

void removeMean(std::array<float, area>& values) {
  float sum = 0;
  for (const float value : values) sum += value;
  for (float& value : values) value -= sum / area;
}

std::vector<Patch> makePatches(const Camera& camera, const cv::Mat& image, int level,
                               const std::vector<AlignmentPoint>& points) {
  const double scale = 1.0 / (1 << level);
  std::vector<Patch> patches;
  patches.reserve(points.size());
  for (const AlignmentPoint& point : points) {
    constexpr int outer = side + 2;
    std::array<float, outer * outer> samples;
    if (!sample(image, point.pixel.x() * scale, point.pixel.y() * scale, outer, samples.data())) continue;
    Patch patch;
    patch.position = point.position;
    for (int v = 0; v < side; ++v) {
      for (int u = 0; u < side; ++u) {
        const int inner = (v + 1) * outer + u + 1;
        const auto centre = static_cast<std::size_t>(inner);
        const int within = v * side + u;
        const auto index = static_cast<std::size_t>(within);
        patch.grey[index] = samples[centre];
        patch.gradient_x[index] = 0.5f * (samples[centre + 1] - samples[centre - 1]);
        patch.gradient_y[index] = 0.5f * (samples[centre + outer] - samples[centre - outer]);
      }
    }
    removeMean(patch.grey);
    removeMean(patch.gradient_x);
    removeMean(patch.gradient_y);
    Eigen::Matrix<double, 2, 3> jacobian;
    project(camera, point.position, &jacobian);
    patch.pixel_by_motion << jacobian * scale, -jacobian * skew(point.position) * scale;
    patches.push_back(patch);
  }
  return patches;
}

struct Comparison {
  int patches = 0;
  double cost = 0;  // robust, a patch
  Matrix6d normal_matrix = Matrix6d::Zero();
  Vector6d right = Vector6d::Zero();
};

Comparison compare(const Camera& camera, const std::vector<Patch>& patches, const cv::Mat& image, int level,
                   const Pose& to_T_from, double huber) {
  const double scale = 1.0 / (1 << level);
  const Eigen::Matrix3d rotation = to_T_from.rotation.toRotationMatrix();
  Comparison sum;
  std::array<float, area> samples;
  for (const Patch& patch : patches) {
    const Eigen::Vector3d moved = rotation * patch.position + to_T_from.translation;
    if (moved.z() < 0.05 * patch.position.z()) continue;
    const Eigen::Vector2d pixel = project(camera, moved) * scale;
    if (!(pixel.x() > 0 && pixel.y() > 0 && pixel.x() < image.cols - 1 && pixel.y() < image.rows - 1)) continue;
    if (!sample(image, pixel.x(), pixel.y(), side, samples.data())) continue;
    removeMean(samples);
    float square = 0, xx = 0, xy = 0, yy = 0, x_right = 0, y_right = 0;
    for (std::size_t i = 0; i < area; ++i) {
      const float difference = samples[i] - patch.grey[i];
      square += difference * difference;
      xx += patch.gradient_x[i] * patch.gradient_x[i];
      xy += patch.gradient_x[i] * patch.gradient_y[i];
      yy += patch.gradient_y[i] * patch.gradient_y[i];
      x_right += patch.gradient_x[i] * difference;
      y_right += patch.gradient_y[i] * difference;
    }
    const double root = std::sqrt(square / area);
    const double weight = root > huber ? huber / root : 1.0;
    sum.cost += root > huber ? huber * (2 * root - huber) : root * root;
    Eigen::Matrix2d tensor;
    tensor << xx, xy, xy, yy;
    sum.normal_matrix += weight * patch.pixel_by_motion.transpose() * tensor * patch.pixel_by_motion;
    sum.right += weight * patch.pixel_by_motion.transpose() * Eigen::Vector2d(x_right, y_right);
    ++sum.patches;
  }
  if (sum.patches > 0) sum.cost /= sum.patches;
  return sum;
}

}  // namespace

Pose alignSparsely(const Camera& camera, const ImagePyramid& from, const ImagePyramid& to,
                   const std::vector<AlignmentPoint>& points, const Pose& first_start, const Pose& second_start,
                   const SparseAlignmentOptions& options) {
  Pose to_T_from = first_start;
  bool compared = false;
  for (int level = options.coarsest_level; level >= options.finest_level; --level) {
    const auto index = static_cast<std::size_t>(level);
    if (index >= from.levels.size() || index >= to.levels.size()) continue;
    const std::vector<Patch> patches = makePatches(camera, from.levels[index], level, points);
    Comparison best = compare(camera, patches, to.levels[index], level, to_T_from, options.huber);
    if (!compared) {
      const Comparison other = compare(camera, patches, to.levels[index], level, second_start, options.huber);
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
      const Comparison next = compare(camera, patches, to.levels[index], level, next_pose, options.huber);
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
