// A copy of a simulated sequence in which some frames are not what the lens saw. The others are links to the original.
#pragma once

#include <functional>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "unit/files/temporary_folder.h"

namespace edgeslam {

class SpoiltSequence {
 public:
  // The first `count` frames of a sequence in TUM layout. Throws std::runtime_error where it has fewer.
  SpoiltSequence(const std::string& folder, int count);

  // Frame `index` of the original, CV_8U.
  cv::Mat original(int index) const;

  // Puts `spoil(index)` in the place of frames `first` to `last`, both of them.
  void replace(int first, int last, const std::function<cv::Mat(int)>& spoil);

  // The picture of frame `of` comes once more in the place of frame `index`. What it shows is from where `of` was
  // taken, and so is the truth of it.
  void repeat(int index, int of);

  // No frame comes at its time. The numbers of the others stay what they were until the sequence is written.
  void drop(int index);

  // After the last frame `count` more, `interval_s` apart: the pictures from frame `first` on, over and over.
  void standStill(int first, int count, double interval_s);

  int size() const;  // frames that come

  // In TUM layout, with ground truth. Returns the path of folder `name`, made in `folder`.
  std::string write(const TemporaryFolder& folder, const std::string& name) const;

 private:
  struct Frame {
    std::string time, picture, pose;
    cv::Mat spoilt;  // in the place of the picture, where not empty
    bool comes = true;
  };

  std::string folder_;
  std::vector<Frame> frames_;
};

}  // namespace edgeslam
