// Images on which a kernel and its reference are compared: random, flat, saturated, tiny, of odd sizes, and with rows
// that start at odd addresses.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace edgeslam {

// Each a view, with `border` pixels of noise around it.
inline std::vector<cv::Mat> kernelImages(int border) {
  std::vector<cv::Mat> images;
  cv::RNG random(7);
  for (const cv::Size& size :
       {cv::Size(1, 1), cv::Size(2, 3), cv::Size(7, 40), cv::Size(40, 7), cv::Size(31, 33), cv::Size(64, 48),
        cv::Size(65, 47), cv::Size(130, 20), cv::Size(333, 61), cv::Size(640, 40), cv::Size(1291, 12)}) {
    for (const int left : {border, border + 1}) {
      for (const int kind : {0, 1, 2, 3}) {
        cv::Mat whole(size.height + 2 * border, size.width + left + border + 3, CV_8U);
        if (kind == 0) random.fill(whole, cv::RNG::UNIFORM, 0, 256);
        if (kind == 1) whole.setTo(173);
        if (kind == 2) {  // black and white
          random.fill(whole, cv::RNG::UNIFORM, 0, 2);
          whole *= 255;
        }
        if (kind == 3) whole.setTo(255);
        images.push_back(whole(cv::Rect(cv::Point(left, border), size)));
      }
    }
  }
  return images;
}

}  // namespace edgeslam
