#include "tracking/measurement_accuracy.h"

#include <algorithm>
#include <cmath>

namespace edgeslam {

void updateAccuracy(const cv::Mat& grey, const PointChoiceOptions& options, Track& track) {
  const StructureTensor tensor = structureTensor(grey, track.pixel, options.tensor_window);
  track.normal = tensor.direction.dot(track.normal) >= 0 ? tensor.direction : Eigen::Vector2f(-tensor.direction);
  track.corner = tensor.l2 > static_cast<float>(options.corner_ratio) * tensor.l1 &&
                 tensor.l2 > static_cast<float>(options.corner_strength);
  track.sigma_normal = static_cast<float>(track.corner ? options.sigma_corner : options.sigma_edge);
  const float along = std::max(1e-6f, tensor.l2 - static_cast<float>(options.noise));
  track.sigma_tangent = std::min(1000.0f, track.sigma_normal * std::sqrt(tensor.l1 / along));
  if (!options.weigh_edges) track.sigma_tangent = track.sigma_normal;
}

}  // namespace edgeslam
