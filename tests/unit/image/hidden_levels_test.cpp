#include "image/hidden_levels.h"

#include <gtest/gtest.h>

#include "image/pyramid.h"

namespace edgeslam {
namespace {

cv::Mat maskedOnTop(int rows) {
  cv::Mat masked(240, 320, CV_8U, cv::Scalar(0));
  masked.rowRange(0, rows).setTo(255);
  return masked;
}

TEST(HiddenLevels, HaveTheSizesOfThePyramids) {
  const HiddenLevels hidden = hiddenLevels(maskedOnTop(40), 4, 1);
  const ImagePyramid pyramid = buildPyramid(maskedOnTop(40), 4);
  ASSERT_EQ(hidden.size(), pyramid.levels.size());
  for (std::size_t level = 0; level < hidden.size(); ++level) {
    EXPECT_EQ(hidden[level].size(), pyramid.levels[level].size());
  }
}

TEST(HiddenLevels, WindowsThatTouchWhatIsMaskedAreHidden) {
  const HiddenLevels hidden = hiddenLevels(maskedOnTop(40), 4, 3);
  EXPECT_TRUE(isHiddenAt(hidden, 0, 100, 42));
  EXPECT_FALSE(isHiddenAt(hidden, 0, 100, 43));
  // Row 5 of level 3 is where row 40 is, and sees a share of what is above.
  EXPECT_TRUE(isHiddenAt(hidden, 3, 10, 7));
  EXPECT_FALSE(isHiddenAt(hidden, 3, 10, 9));
}

TEST(HiddenLevels, OutsideOfTheImageTheNearestPixelCounts) {
  const HiddenLevels hidden = hiddenLevels(maskedOnTop(40), 4, 3);
  EXPECT_TRUE(isHiddenAt(hidden, 0, -20, -20));
  EXPECT_FALSE(isHiddenAt(hidden, 0, 400, 300));
  EXPECT_FALSE(isHiddenAt(hidden, 9, 10, 10)) << "there is no such level";
  EXPECT_FALSE(isHiddenAt({}, 0, 10, 10));
}

}  // namespace
}  // namespace edgeslam
