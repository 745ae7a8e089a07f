// P5: the sums that patches are aligned by have the same bits on every instruction set.
#include "flow/patch_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "unit/image/every_target.h"

namespace edgeslam {
namespace {

constexpr std::ptrdiff_t row_step = 77;  // odd: rows are not aligned
constexpr int rows = 40;

enum class Content { random, flat, extremes };

std::vector<std::uint8_t> pixels(Content content, std::uint32_t seed) {
  std::vector<std::uint8_t> values(static_cast<std::size_t>(row_step * rows));
  std::mt19937 random(seed);
  for (std::uint8_t& value : values) {
    value = content == Content::random ? static_cast<std::uint8_t>(random() % 256)
            : content == Content::flat ? 255
            : random() % 2             ? 255
                                       : 0;
  }
  return values;
}

struct Case {
  std::vector<std::uint8_t> image, other;
  BilinearWeights weights;
  std::ptrdiff_t corner = 0;
};

std::vector<Case> cases() {
  std::vector<Case> made;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> share(0, 1);
  for (const Content content : {Content::random, Content::flat, Content::extremes}) {
    for (int i = 0; i < 20; ++i) {
      Case one{pixels(content, random()), pixels(content, random()), bilinearWeights(share(random), share(random)), 0};
      one.corner = row_step * static_cast<std::ptrdiff_t>(random() % 10) + static_cast<std::ptrdiff_t>(random() % 20);
      made.push_back(one);
    }
  }
  made.back().weights = bilinearWeights(1, 1);
  made.front().weights = bilinearWeights(0, 0);
  return made;
}

TEST(PatchKernels, GiveTheReferencesBitsOnEveryInstructionSet) {
  const std::vector<Case> all = cases();
  onEveryTarget([&] {
    for (const Case& one : all) {
      for (const int side : {1, 3, 7, 8, 11, 13, 15}) {
        SampledWindow window{}, window_reference{};
        sampleWindow(one.image.data() + one.corner, row_step, one.weights, side, window);
        sampleWindowReference(one.image.data() + one.corner, row_step, one.weights, side, window_reference);
        ASSERT_EQ(window, window_reference) << side;

        PatchSamples patch{}, patch_reference{};
        const PatchSums sums = makePatchSamples(window, side, patch);
        const PatchSums reference = makePatchSamplesReference(window, side, patch_reference);
        ASSERT_EQ(patch.grey, patch_reference.grey) << side;
        ASSERT_EQ(patch.gradient_x, patch_reference.gradient_x) << side;
        ASSERT_EQ(patch.gradient_y, patch_reference.gradient_y) << side;
        ASSERT_EQ(patch.grey_mean, patch_reference.grey_mean);
        ASSERT_EQ(patch.x_mean, patch_reference.x_mean);
        ASSERT_EQ(patch.y_mean, patch_reference.y_mean);
        for (const auto sum :
             {&PatchSums::grey, &PatchSums::x, &PatchSums::y, &PatchSums::grey_grey, &PatchSums::grey_x,
              &PatchSums::grey_y, &PatchSums::xx, &PatchSums::xy, &PatchSums::yy}) {
          ASSERT_EQ(sums.*sum, reference.*sum) << side;
        }
        const std::uint8_t* other = one.other.data() + one.corner;
        ASSERT_TRUE(comparePatch(patch, other, row_step, one.weights) ==
                    comparePatchReference(patch, other, row_step, one.weights))
            << side;
        ASSERT_TRUE(correlatePatch(patch, other, row_step, one.weights) ==
                    correlatePatchReference(patch, other, row_step, one.weights))
            << side;
      }
    }
  });
}

TEST(PatchKernels, SumsOfTheLargestContrastDoNotOverflow) {
  for (const Case& one : cases()) {
    SampledWindow window{};
    sampleWindow(one.image.data() + one.corner, row_step, one.weights, largest_patch_side, window);
    PatchSamples patch{};
    const PatchSums sums = makePatchSamples(window, largest_patch_side, patch);
    std::int64_t xx = 0, grey_grey = 0;
    for (const std::int16_t value : patch.gradient_x) xx += std::int64_t{value} * value;
    for (const std::int16_t value : patch.grey) grey_grey += std::int64_t{value} * value;
    EXPECT_EQ(sums.xx, xx);
    EXPECT_EQ(sums.grey_grey, grey_grey);
    // What is largest: bright where the gradient is positive, black elsewhere.
    std::int64_t most = 0;
    for (const std::int16_t value : patch.gradient_x) most += std::max<std::int64_t>(0, value) * 255 * samples_per_grey;
    EXPECT_LT(most, std::int64_t{1} << 31);
  }
}

TEST(BilinearWeights, SumUpToOneAndAreWithinAHalfStep) {
  for (float right = 0; right <= 1; right += 0.01f) {
    for (float below = 0; below <= 1; below += 0.01f) {
      const BilinearWeights weights = bilinearWeights(right, below);
      EXPECT_EQ(weights.here + weights.right + weights.below + weights.below_right, 256);
      EXPECT_LE(weights.here, 256);
      EXPECT_NEAR(weights.below_right, right * below * 256, 0.51f);
      EXPECT_NEAR(weights.right + weights.below_right, right * 256, 0.51f);
      EXPECT_NEAR(weights.below + weights.below_right, below * 256, 0.51f);
    }
  }
}

}  // namespace
}  // namespace edgeslam
