// The metric scale as it is known: how many metres a map unit is, and from what.
#pragma once

namespace edgeslam {

enum class ScaleKind { unknown, known_distance, camera_height, odometry, inertia };

struct ScaleState {
  ScaleKind kind = ScaleKind::unknown;
  double metres_per_unit = 1;  // 1 while unknown
  double sigma = 0;            // standard deviation of the scale over the scale; 0 while unknown
};

}  // namespace edgeslam
