// How much more the measurements of a recording err than is presumed of a good camera: rolling shutter, a calibration
// that is roughly right and blur make errors that no single image shows, but all map points in view do. They are
// measured before a pose is judged, so that a camera that errs more is not taken for one that is lost.
#pragma once

#include <array>
#include <cstddef>
#include <memory_resource>
#include <vector>

#include "edges/point_accuracy.h"
#include "map/keyframe.h"

namespace edgeslam {

struct MeasuredNoiseOptions {
  double most = 4;  // times what is presumed; 1: what is presumed is never scaled
  // Errors of noise stay within 12 standard deviations; a frame in which fewer of the points do contradicts the map
  // and says nothing of the noise.
  double least_share_within_12_sigma = 0.9;
};

// What the map points in view of one frame say.
struct NoiseEvidence {
  int points = 0;
  double ratio = 1;                  // of the errors across the edges over what is presumed by now; 1: as presumed
  double share_within_12_sigma = 1;  // of the points
};

// `errors_across`: of all map points followed, whether they agree with the pose or not, each in its presumed standard
// deviations. The ratio is that of a quantile low enough that what moves by itself hardly counts.
NoiseEvidence noiseEvidence(const std::pmr::vector<double>& errors_across, std::pmr::memory_resource* memory);

// False where there are too few points.
bool saysSomething(const NoiseEvidence& evidence);

// Followed over the latest frames: what only a few of them say, as blur in a shake does, is passed over.
class MeasuredNoise {
 public:
  explicit MeasuredNoise(const MeasuredNoiseOptions& options) : options_(options) {}

  // Returns how many times as large the standard deviations of measurements must be taken as before.
  double observe(const NoiseEvidence& evidence);

  // Standard deviations of measurements, times what is presumed of a good camera; at least 1.
  double factor() const { return factor_; }

 private:
  MeasuredNoiseOptions options_;
  double factor_ = 1;
  std::array<double, 9> levels_{};  // that the latest frames told, times what is presumed
  std::size_t observed_ = 0;        // frames
};

// The factor that the measurements of a keyframe were taken with; `presumed`: what is presumed of a good camera.
double noiseFactorOf(const Keyframe& keyframe, const PointAccuracyOptions& presumed);

}  // namespace edgeslam
