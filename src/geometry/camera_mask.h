// Where a camera's images are never looked at: the robot's own body in view. Made once a run, and shared.
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>

#include "geometry/camera.h"

namespace edgeslam {

// How far windows reach at full size, and all but the last thousandths of a filter: what is measured farther from the
// mask does not see what is under it [px].
constexpr int mask_margin = 8;

// Images of the camera's size, CV_8U, 255 or 0.
struct CameraMask {
  cv::Mat masked;  // 255 under the mask itself
  cv::Mat hidden;  // 255 there and nearer to it than mask_margin
};

// Of a grey image (CV_8U): what is darker than 128 is masked.
std::shared_ptr<const CameraMask> makeCameraMask(const cv::Mat& image);

// Of the image's pixels, those under the mask itself.
double maskedShare(const CameraMask& mask);

// False where nothing is left of the image.
bool leavesSomething(const CameraMask& mask);

// The pixel lies in the image.
inline bool isHidden(const CameraMask* mask, const Eigen::Vector2d& pixel) {
  return mask && mask->hidden.at<unsigned char>(cvRound(pixel.y()), cvRound(pixel.x())) != 0;
}

// True where a pixel lies inside the image by at least `border` (0 or more) [px], and is not hidden.
inline bool isLookedAt(const Camera& camera, const Eigen::Vector2d& pixel, double border) {
  return insideImage(camera, pixel, border) && !isHidden(camera.mask.get(), pixel);
}

}  // namespace edgeslam
