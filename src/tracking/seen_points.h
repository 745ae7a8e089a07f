// Where a frame's tracks were measured, packed: what its pose is found from once more when the run ends.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/camera.h"
#include "tracking/track.h"

namespace edgeslam {

struct PackedPoint {
  std::uint32_t after_first = 0;  // number of the point, over that of the first one
  std::uint16_t x = 0, y = 0;     // [pixel step]
  Eigen::half normal_x{}, normal_y{};
  Eigen::half sigma_normal{}, sigma_tangent{};  // [px]
};

// To a fraction of what can be measured: pixels to a 65536th of the image's longer side, directions and standard
// deviations to a thousandth.
struct SeenPoints {
  PointId first = 0;
  double pixel_step = 1;  // [px]
  std::vector<PackedPoint> points;
};

// Writes over `seen`: the first `most` tracks, whose numbers ascend. Without allocation where there is memory for as
// many.
void pack(const Camera& camera, const std::vector<Track>& tracks, std::size_t most, SeenPoints& seen);

struct SeenPoint {
  PointId point = 0;
  Measurement measurement;
};

SeenPoint seenPoint(const SeenPoints& seen, std::size_t index);

}  // namespace edgeslam
