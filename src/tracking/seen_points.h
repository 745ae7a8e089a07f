// Where a frame's tracks were measured, packed: what its pose is found from once more when the run ends.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/camera.h"
#include "tracking/track.h"

namespace edgeslam {

// To a fraction of what can be measured: pixels to a 65536th of the image's longer side, directions and standard
// deviations to a thousandth.
class SeenPoints {
 public:
  struct Seen {
    PointId point = 0;
    Measurement measurement;
  };

  // Takes the memory for so many points.
  void reserve(std::size_t points) { points_.reserve(points); }
  void clear() { points_.clear(); }
  // Gives the memory back.
  void forget() { points_ = {}; }

  // In place of what there was: the first `most` tracks. Without allocation where there is memory for as many.
  void assign(const Camera& camera, const std::vector<Track>& tracks, std::size_t most);

  std::size_t size() const { return points_.size(); }
  std::size_t bytes() const { return points_.size() * sizeof(Packed); }
  Seen operator[](std::size_t i) const;

 private:
  struct Packed {
    std::uint32_t after_first = 0;  // number of the point, over that of the first one
    std::uint16_t x = 0, y = 0;     // [pixel step]
    Eigen::half normal_x{}, normal_y{};
    Eigen::half sigma_normal{}, sigma_tangent{};  // [px]
  };

  PointId first_ = 0;
  double pixel_step_ = 1;  // [px]
  std::vector<Packed> points_;
};

}  // namespace edgeslam
