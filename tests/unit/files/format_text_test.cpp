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

}  // namespace
}  // namespace edgeslam
