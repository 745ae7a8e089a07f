#include "configuration/configuration_value.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace edgeslam {
namespace {

TEST(ConfigurationValue, ANumberIsWrittenSoThatItReadsBackToTheLastBit) {
  for (const double value : {0.1, 1.0 / 3, 1e-300, 123456789.123456789, -0.0, 5e20, 1.78}) {
    double read = 1;
    ASSERT_TRUE(parseNumber(numberText(value), read)) << numberText(value);
    EXPECT_EQ(read, value);
    EXPECT_EQ(std::signbit(read), std::signbit(value));
  }
}

TEST(ConfigurationValue, ParsesFiniteNumbersOnly) {
  double value = 7;
  for (const char* text :
       {"", " 1", "1 ", "1,5", "nan", ".nan", "inf", "-inf", ".inf", "1e999", "0x10", "1.5px", "--1", "+-1", "+"}) {
    EXPECT_FALSE(parseNumber(text, value)) << "'" << text << "'";
    EXPECT_EQ(value, 7);
  }
  EXPECT_TRUE(parseNumber("+1.5e1", value));
  EXPECT_EQ(value, 15);
}

TEST(ConfigurationValue, BoundsAreAllowedAndWhatIsBeyondIsNot) {
  double number = 0;
  const ConfigurationKey key{"a.b", &number, "px", 1.5, 3, "test"};
  EXPECT_EQ(setValue(key, "1.5"), "");
  EXPECT_EQ(setValue(key, "3"), "");
  EXPECT_EQ(number, 3);
  EXPECT_NE(setValue(key, numberText(std::nextafter(1.5, 0))), "");
  EXPECT_NE(setValue(key, numberText(std::nextafter(3.0, 4))), "");
  EXPECT_EQ(number, 3);
  EXPECT_EQ(expectedValue(key), "1.5 to 3 px");
}

TEST(ConfigurationValue, WhatMustBeOddIs) {
  int side = 5;
  const ConfigurationKey key{"a.b", &side, "px", 3, 63, "test", 2};
  EXPECT_NE(setValue(key, "8"), "");
  EXPECT_EQ(side, 5);
  EXPECT_EQ(setValue(key, "9"), "");
  EXPECT_EQ(side, 9);
  EXPECT_EQ(expectedValue(key), "3 to 63 px in steps of 2");
}

TEST(ConfigurationValue, WholeNumbersAndTruthValuesTakeNothingElse) {
  int count = 5;
  const ConfigurationKey whole{"a.b", &count, "", 0, std::numeric_limits<int>::max(), "test"};
  EXPECT_NE(setValue(whole, "1.5"), "");
  EXPECT_NE(setValue(whole, "99999999999"), "");
  EXPECT_EQ(count, 5);
  EXPECT_EQ(setValue(whole, "2147483647"), "");
  EXPECT_EQ(count, std::numeric_limits<int>::max());

  bool flag = false;
  const ConfigurationKey truth{"a.c", &flag, "", 0, 0, "test"};
  EXPECT_NE(setValue(truth, "1"), "");
  EXPECT_NE(setValue(truth, "yes"), "");
  EXPECT_EQ(setValue(truth, "true"), "");
  EXPECT_TRUE(flag);
  EXPECT_EQ(valueText(truth.field), "true");
}

}  // namespace
}  // namespace edgeslam
