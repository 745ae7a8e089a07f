// Rotation between two frames from their small images alone, coarse to fine by inverse-compositional Gauss-Newton
// (Baker and Matthews 2004; Klein and Murray 2008 use it to relocalise). It starts the flow where the camera turned in
// a way that constant velocity does not foresee.
#pragma once

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "geometry/camera.h"
#include "image/pyramid.h"

namespace edgeslam {

// Samples of one pyramid level that every frame of a camera shares.
struct RotationGrid {
  struct Sample {
    int x = 0, y = 0;                               // in the level's pixels
    Eigen::Vector3d bearing;                        // unit
    Eigen::Matrix<double, 2, 3> pixel_by_rotation;  // d level pixel / d rotation vector
  };
  int level = 0;
  std::vector<Sample> samples;
  cv::Mat hidden;  // CV_8U, of the level's size: not 0 where the camera's mask shows; empty: nowhere
};

// Grids for levels 5 to 3, some 600 samples each at most, where the camera's mask does not show.
std::vector<RotationGrid> makeRotationGrids(const Camera& camera);

// The same grids, made for `camera`, where it was found to be another one: of the same size and mask. Takes no memory.
void renewRotationGrids(const Camera& camera, std::vector<RotationGrid>& grids);

// to_R_from, from `initial`. Returns `initial` where the images cannot be compared.
Eigen::Quaterniond alignRotation(const Camera& camera, const std::vector<RotationGrid>& grids, const ImagePyramid& from,
                                 const ImagePyramid& to, const Eigen::Quaterniond& initial);

}  // namespace edgeslam
