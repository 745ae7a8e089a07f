// P22: a keyframe that looks like the frame at hand is found by a small blurred image of each (after the relocalisation
// of Klein and Murray, ECCV 2008), compared at small shifts and turns, which also tell about how the camera is turned.
#pragma once

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include "geometry/camera_mask.h"
#include "image/pyramid.h"

namespace edgeslam {

constexpr int thumbnail_width = 40;  // [px]

using Thumbnail = cv::Mat;  // CV_32F, thumbnail_width wide, of the image's proportions

// 0, as a plain image would be, where `mask` hides the image.
Thumbnail makeThumbnail(const ImagePyramid& pyramid, const CameraMask* mask = nullptr);

// How a thumbnail lies on another one: pixel p of the second is seen at centre + turn (p - centre) + shift in the
// first.
struct ThumbnailMatch {
  double correlation = -1;                          // normalized, of what overlaps
  double roll = 0;                                  // [rad], from x towards y
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();  // [px of the thumbnail]
};

// Best match over shifts of at most a quarter of the image, without a turn.
ThumbnailMatch matchShifted(const Thumbnail& first, const Thumbnail& second);

// Like the match without turns, over turns of up to 24 degrees too; the shift to a fraction of a pixel.
ThumbnailMatch matchTurned(const Thumbnail& first, const Thumbnail& second);

// Rotation first_R_second of a camera that only turned between the two thumbnails.
Eigen::Quaterniond rotationOf(const Camera& camera, const ThumbnailMatch& match);

}  // namespace edgeslam
