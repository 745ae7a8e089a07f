#include "tracking/measurement_accuracy.h"

#include <algorithm>
#include <cmath>

namespace edgeslam {

void updateAccuracy(const cv::Mat& grey, const PointAccuracy& accuracy, Track& track) {
  const PointAccuracyOptions& options = accuracy.options;
  const StructureTensor tensor = structureTensor(grey, track.pixel, options.tensor_window);
  track.normal = tensor.direction.dot(track.normal) >= 0 ? tensor.direction : Eigen::Vector2f(-tensor.direction);
  track.corner = isCornerLike({tensor.l1, tensor.l2}, accuracy);
  track.sigma_normal = static_cast<float>(sigmaAcross(track.corner, accuracy));
  track.sigma_tangent =
      std::min(1000.0f, track.sigma_normal * std::sqrt(tensor.l1 / informativeL2(tensor.l2, accuracy)));
  if (!options.weigh_edges) track.sigma_tangent = track.sigma_normal;
}

}  // namespace edgeslam
