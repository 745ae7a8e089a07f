#include "files/format_text.h"

#include <gtest/gtest.h>

namespace edgeslam {
namespace {

TEST(FormatText, IsWhatPrintfPrints) {
  EXPECT_EQ(formatted("%s: %.3f px, %d of %zu", "fx", 299.5, 3, std::size_t{7}), "fx: 299.500 px, 3 of 7");
  EXPECT_EQ(formatted("%.1f %%", 12.25), "12.2 %");
  EXPECT_EQ(formatted("%s", ""), "");
}

TEST(FormatText, IsWholeHoweverLong) {
  const std::string long_text(5000, 'a');
  EXPECT_EQ(formatted("<%s>", long_text.c_str()), "<" + long_text + ">");
}

TEST(FormatText, WithoutDigitsLinesThatDifferInNumbersAreTheSame) {
  EXPECT_EQ(withoutDigits("12.5 ms late, 3 times"), " ms late,  times");
  EXPECT_EQ(withoutDigits("80 ms late, 17 times"), withoutDigits("5.25 ms late, 3 times"));
  EXPECT_NE(withoutDigits("80 ms late"), withoutDigits("80 s late"));
}

}  // namespace
}  // namespace edgeslam
