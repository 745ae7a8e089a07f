// Proposes a camera's mask (geometry/camera_mask.h) from images between which the camera moves: edges that stay where
// they are while the others change are the robot's own body's, and so is what they enclose.
#pragma once

#include <opencv2/core/mat.hpp>

namespace edgeslam {

// The edges of many images, each pixel's on its own.
class EdgeChanges {
 public:
  // Straight ahead, a horizon or a skirting board may stay where it is for some hundred views.
  static constexpr int fewest_views = 150;

  // `grey`: CV_8U, of the size of those before. One that shows about what the last that counted shows is passed over: a
  // camera that stands still says nothing.
  void add(const cv::Mat& grey);

  // The images that counted.
  int views() const { return views_; }
  bool tellEnough() const { return views_ >= fewest_views; }
  // The last of them; empty before the first.
  const cv::Mat& latestView() const { return latest_view_; }

  // CV_8U, of the images' size: 0 where masked, 255 elsewhere. There is a view.
  cv::Mat proposeMask() const;

 private:
  // Gradients of a smoothed image, shortened to a length below 1, so that all steep edges count alike. CV_32F.
  struct Directions {
    cv::Mat x, y;
  };
  static Directions directions(const cv::Mat& grey);
  static double changedShare(const Directions& a, const Directions& b);

  int views_ = 0;
  cv::Mat latest_view_;
  Directions latest_, sum_;
  cv::Mat squares_;  // sum of their squared lengths
};

// A picture to look at (CV_8UC3): what is masked is red over `grey`, of the same size.
cv::Mat drawMask(const cv::Mat& grey, const cv::Mat& mask);

}  // namespace edgeslam
