#include "geometry/camera_mask.h"

#include <opencv2/imgproc.hpp>

namespace edgeslam {

std::shared_ptr<const CameraMask> makeCameraMask(const cv::Mat& image) {
  CV_Assert(image.type() == CV_8U && !image.empty());
  constexpr int side = 2 * mask_margin + 1;
  auto mask = std::make_shared<CameraMask>();
  mask->masked = image < 128;
  cv::dilate(mask->masked, mask->hidden, cv::getStructuringElement(cv::MORPH_RECT, {side, side}));
  return mask;
}

double maskedShare(const CameraMask& mask) {
  return static_cast<double>(cv::countNonZero(mask.masked)) / static_cast<double>(mask.masked.total());
}

bool leavesSomething(const CameraMask& mask) {
  return cv::countNonZero(mask.hidden) < static_cast<int>(mask.hidden.total());
}

}  // namespace edgeslam
