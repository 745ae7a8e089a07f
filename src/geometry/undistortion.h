// Bearings of sets of pixels: many distortions inverted at a time.
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "geometry/camera.h"

namespace edgeslam {

// The bearing (unit vector, camera frame) of each of `count` pixels: what bearing() gives, to the last bit.
void bearingsOf(const Camera& camera, const Eigen::Vector2d* pixels, std::size_t count, Eigen::Vector3d* bearings);

// What bearingsOf gives, one pixel after the other.
void bearingsReference(const Camera& camera, const Eigen::Vector2d* pixels, std::size_t count,
                       Eigen::Vector3d* bearings);

}  // namespace edgeslam
