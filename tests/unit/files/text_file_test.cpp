#include "files/text_file.h"

#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

TEST(TextFile, StampsAreExactToTheNanosecond) {
  EXPECT_EQ(parseStamp("1305031102.175304"), 1305031102175304000);
  EXPECT_EQ(parseStamp("1305031102.1753040009"), 1305031102175304001);  // rounded
  EXPECT_EQ(parseStamp("0"), 0);
  EXPECT_EQ(parseStamp("12"), 12000000000);
  EXPECT_EQ(parseStamp(".5"), 500000000);
  EXPECT_EQ(parseStamp("-1.5"), -1500000000);
  EXPECT_EQ(parseStamp("1.305031102175304e+09"), 1305031102175304000);
  EXPECT_EQ(parseStamp("15e-10"), 2);
}

TEST(TextFile, WholeStampsOfNanosecondsAreTakenAsSuch) {
  EXPECT_EQ(parseStamp("1403636579763555584"), 1403636579763555584);
  EXPECT_EQ(parseStamp("1000000000000000"), 1000000000000000);
  EXPECT_EQ(parseStamp("999999999"), 999999999000000000);
}

TEST(TextFile, WhatIsNoStampIsRefused) {
  for (const char* text : {"", ".", "-", "nan", "inf", "1e", "1e999", "1.2.3", "12a", "0x10", "1,5", "9e18", " 1",
                           "99999999999999999999", "4000000001.0", "1e-101"}) {
    EXPECT_FALSE(parseStamp(text)) << text;
  }
  EXPECT_FALSE(parseStamp(std::string(1000, '1')));
  EXPECT_FALSE(parseNanoseconds("1.5"));
  EXPECT_FALSE(parseNanoseconds("9223372036854775807"));
}

TEST(TextFile, StampsSurviveWritingAndReading) {
  for (const std::int64_t time : std::initializer_list<std::int64_t>{0, 1, -1, 999999999, -1000000001,
                                                                     1403636579763555584, -4000000000000000000}) {
    EXPECT_EQ(parseStamp(formatStamp(time)), time) << formatStamp(time);
  }
}

TEST(TextFile, NumbersMustBeFiniteAndWhole) {
  EXPECT_EQ(parseNumber("-1.5e3"), -1500.0);
  EXPECT_EQ(parseNumber("+2"), 2.0);
  for (const char* text : {"", "nan", "inf", "-inf", "1e999", "1.5x", "1 2", "--1"}) {
    EXPECT_FALSE(parseNumber(text)) << text;
  }
}

TEST(TextFile, LinesKeepTheirNumbers) {
  const TemporaryFolder folder;
  const std::vector<TextLine> lines = readTextLines(folder.write("a.txt", "# comment\r\n\r\n  one two \r\n#\nthree"));
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].number, 3);
  EXPECT_EQ(lines[0].text, "one two");
  EXPECT_EQ(lines[1].number, 5);
  EXPECT_EQ(lines[1].text, "three");
}

TEST(TextFile, AStampIsRoundedOnlyWithinItsRange) {
  EXPECT_EQ(parseStamp("4000000000.0000000004"), 4000000000000000000);
  EXPECT_EQ(parseStamp("4000000000.0000000005"), std::nullopt);
}

TEST(InputErrorMessage, IsOneLineWhateverAFileHolds) {
  EXPECT_STREQ(InputError("f.txt:1: 'a\nb\x1b[31m\x7f' is no number: \xc3\xa9").what(),
               "f.txt:1: 'a?b?[31m?' is no number: \xc3\xa9");
  EXPECT_LT(std::string(InputError("f.txt: " + std::string(100'000, 'x')).what()).size(), 10'000U);
}

TEST(TextFile, MissingFilesAndFoldersAreToldApart) {
  const TemporaryFolder folder;
  expectInputError([&] { readTextLines(folder.path("none")); }, folder.path("none"), "no such file");
  expectInputError([&] { readTextLines(folder.path()); }, "expected a text file");
  expectInputError([&] { readTextLines("/dev/zero"); }, "expected a text file");
}

}  // namespace
}  // namespace edgeslam
