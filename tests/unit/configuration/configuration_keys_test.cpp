#include "configuration/configuration_keys.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

namespace edgeslam {
namespace {

TEST(ConfigurationKeys, EachIsWellFormedAndDocumented) {
  Settings settings;
  std::set<std::string> paths;
  std::string section;
  for (const ConfigurationKey& key : configurationKeys(settings)) {
    EXPECT_TRUE(paths.insert(key.path).second) << key.path << " is there twice";
    EXPECT_FALSE(key.documentation.empty()) << key.path;
    const std::size_t dot = key.path.find('.');
    if (key.isHeading()) {
      EXPECT_EQ(dot, std::string::npos) << key.path;
      section = key.path;
    } else {
      EXPECT_EQ(key.path.substr(0, dot), section) << key.path << " stands outside its section";
      EXPECT_EQ(key.path.find('.', dot + 1), std::string::npos) << key.path;
    }
  }
}

TEST(ConfigurationKeys, EachHasAFieldOfItsOwn) {
  Settings settings;
  std::set<const void*> fields;
  for (const ConfigurationKey& key : configurationKeys(settings)) {
    const void* field = nullptr;
    if (const auto* number = std::get_if<double*>(&key.field)) field = *number;
    if (const auto* count = std::get_if<int*>(&key.field)) field = *count;
    if (const auto* flag = std::get_if<bool*>(&key.field)) field = *flag;
    if (!field) continue;
    EXPECT_TRUE(fields.insert(field).second) << key.path << " sets a field that another key sets";
  }
}

TEST(ConfigurationKeys, DefaultsAreInRangeAndReadBackAsTheyAre) {
  Settings settings;
  for (const ConfigurationKey& key : configurationKeys(settings)) {
    if (key.isHeading()) continue;
    const std::string text = valueText(key.field);
    EXPECT_EQ(setValue(key, text), "") << key.path;
    EXPECT_EQ(valueText(key.field), text) << key.path;
  }
}

TEST(ConfigurationKeys, ANumberIsWrittenSoThatItReadsBackToTheLastBit) {
  for (const double value : {0.1, 1.0 / 3, 1e-300, 123456789.123456789, -0.0, 5e20, 1.78}) {
    double read = 1;
    ASSERT_TRUE(parseNumber(numberText(value), read)) << numberText(value);
    EXPECT_EQ(read, value);
    EXPECT_EQ(std::signbit(read), std::signbit(value));
  }
}

TEST(ConfigurationKeys, ParsesFiniteNumbersOnly) {
  double value = 7;
  for (const char* text :
       {"", " 1", "1 ", "1,5", "nan", ".nan", "inf", "-inf", ".inf", "1e999", "0x10", "1.5px", "--1", "+-1", "+"}) {
    EXPECT_FALSE(parseNumber(text, value)) << "'" << text << "'";
    EXPECT_EQ(value, 7);
  }
  EXPECT_TRUE(parseNumber("+1.5e1", value));
  EXPECT_EQ(value, 15);
}

TEST(ConfigurationKeys, BoundsAreAllowedAndWhatIsBeyondIsNot) {
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

TEST(ConfigurationKeys, WhatMustBeOddIs) {
  int side = 5;
  const ConfigurationKey key{"a.b", &side, "px", 3, 63, "test", 2};
  EXPECT_NE(setValue(key, "8"), "");
  EXPECT_EQ(side, 5);
  EXPECT_EQ(setValue(key, "9"), "");
  EXPECT_EQ(side, 9);
  EXPECT_EQ(expectedValue(key), "3 to 63 px in steps of 2");
}

TEST(ConfigurationKeys, WholeNumbersAndTruthValuesTakeNothingElse) {
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
