#include "tracking/rotation_alignment.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "geometry/camera_mask.h"
#include "geometry/pose.h"
#include "image/hidden_levels.h"

namespace edgeslam {
namespace {

constexpr int coarsest_level = 5, finest_level = 3;
constexpr int gradient_reach = 1;  // [px of the level]
constexpr int most_samples = 640;  // of a level: three unknowns need no more

struct RotationComparison {
  int count = 0;
  double mean_square = 0;  // of the grey differences less their mean
  Eigen::Matrix3d normal_matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
};

RotationComparison compare(const Camera& camera, const RotationGrid& grid, const cv::Mat& from, const cv::Mat& to,
                           const Eigen::Quaterniond& to_R_from) {
  const double scale = 1.0 / (1 << grid.level);
  const Eigen::Matrix3d rotation = to_R_from.toRotationMatrix();
  RotationComparison sum;
  double difference_sum = 0, square_sum = 0;
  Eigen::Vector3d gradient_sum = Eigen::Vector3d::Zero();
  for (const RotationGrid::Sample& sample : grid.samples) {
    const Eigen::Vector3d turned = rotation * sample.bearing;
    if (turned.z() < 0.1) continue;
    const Eigen::Vector2d pixel = project(camera, turned) * scale;
    if (!(pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() < to.cols - 1 && pixel.y() < to.rows - 1)) continue;
    const int x = static_cast<int>(pixel.x()), y = static_cast<int>(pixel.y());
    if (!grid.hidden.empty() && grid.hidden.at<unsigned char>(y, x) != 0) continue;
    const double a = pixel.x() - x, b = pixel.y() - y;
    const unsigned char* row = to.ptr(y) + x;
    const unsigned char* below = to.ptr(y + 1) + x;
    const double grey = (1 - b) * ((1 - a) * row[0] + a * row[1]) + b * ((1 - a) * below[0] + a * below[1]);
    const unsigned char* centre = from.ptr(sample.y) + sample.x;
    const auto step = static_cast<std::ptrdiff_t>(from.step[0]);
    const Eigen::RowVector2d gradient(0.5 * (centre[1] - centre[-1]), 0.5 * (centre[step] - centre[-step]));
    const Eigen::Vector3d jacobian = (gradient * sample.pixel_by_rotation).transpose();
    const double difference = grey - centre[0];
    difference_sum += difference;
    square_sum += difference * difference;
    gradient_sum += jacobian;
    sum.normal_matrix += jacobian * jacobian.transpose();
    sum.right += jacobian * difference;
    ++sum.count;
  }
  if (sum.count == 0) return sum;
  const double mean = difference_sum / sum.count;
  sum.mean_square = square_sum / sum.count - mean * mean;
  sum.normal_matrix -= gradient_sum * gradient_sum.transpose() / sum.count;
  sum.right -= gradient_sum * mean;
  return sum;
}

// [px] of the level.
int spacingOfSamples(const Camera& camera, int level) {
  const int pixels = (camera.width >> level) * (camera.height >> level);
  int spacing = 1;
  while (pixels > most_samples * spacing * spacing) ++spacing;
  return spacing;
}

}  // namespace

std::vector<RotationGrid> makeRotationGrids(const Camera& camera) {
  HiddenLevels hidden;
  if (camera.mask) hidden = hiddenLevels(camera.mask->masked, coarsest_level + 1, gradient_reach);
  std::vector<RotationGrid> grids;
  for (int level = coarsest_level; level >= finest_level; --level) {
    RotationGrid grid;
    grid.level = level;
    if (static_cast<std::size_t>(level) < hidden.size()) grid.hidden = hidden[static_cast<std::size_t>(level)];
    const int spacing = spacingOfSamples(camera, level);
    grid.samples.reserve(static_cast<std::size_t>((camera.width >> level) / spacing + 1) *
                         static_cast<std::size_t>((camera.height >> level) / spacing + 1));
    grids.push_back(std::move(grid));
  }
  renewRotationGrids(camera, grids);
  return grids;
}

void renewRotationGrids(const Camera& camera, std::vector<RotationGrid>& grids) {
  for (RotationGrid& grid : grids) {
    const int columns = camera.width >> grid.level, rows = camera.height >> grid.level;
    const int spacing = spacingOfSamples(camera, grid.level);
    grid.samples.clear();
    for (int y = 1; y + 1 < rows; y += spacing) {
      for (int x = 1; x + 1 < columns; x += spacing) {
        if (!grid.hidden.empty() && grid.hidden.at<unsigned char>(y, x) != 0) continue;
        RotationGrid::Sample sample;
        sample.x = x;
        sample.y = y;
        const double size = 1 << grid.level;
        sample.bearing = bearing(camera, {x * size, y * size});
        if (sample.bearing.z() < 0.1) continue;
        Eigen::Matrix<double, 2, 3> jacobian;
        project(camera, sample.bearing, &jacobian);
        sample.pixel_by_rotation = -jacobian * skew(sample.bearing) / size;
        grid.samples.push_back(sample);
      }
    }
  }
}

Eigen::Quaterniond alignRotation(const Camera& camera, const std::vector<RotationGrid>& grids, const ImagePyramid& from,
                                 const ImagePyramid& to, const Eigen::Quaterniond& initial) {
  Eigen::Quaterniond to_R_from = initial;
  for (const RotationGrid& grid : grids) {
    const auto level = static_cast<std::size_t>(grid.level);
    if (level >= from.levels.size() || level >= to.levels.size() || grid.samples.size() < 50) continue;
    RotationComparison best = compare(camera, grid, from.levels[level], to.levels[level], to_R_from);
    for (int iteration = 0; iteration < 10; ++iteration) {
      if (2 * best.count < static_cast<int>(grid.samples.size())) break;
      const Eigen::Vector3d step =
          (best.normal_matrix + 1e-3 * best.count * Eigen::Matrix3d::Identity()).ldlt().solve(best.right);
      const Eigen::Quaterniond turned = (to_R_from * rotationExp(-step)).normalized();
      const RotationComparison next = compare(camera, grid, from.levels[level], to.levels[level], turned);
      if (2 * next.count < static_cast<int>(grid.samples.size()) || next.mean_square >= best.mean_square) break;
      to_R_from = turned;
      best = next;
      if (step.norm() * meanFocalLength(camera) < 0.05 * (1 << grid.level)) break;
    }
  }
  return to_R_from;
}

}  // namespace edgeslam
