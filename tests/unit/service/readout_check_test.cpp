#include "service/readout_check.h"

#include <gtest/gtest.h>

namespace edgeslam {
namespace {

TEST(ReadoutCheck, TheDriversReadoutIsToldWhereNobodySaysAny) {
  const std::string line = readoutLine(0, false, 0.02384);
  EXPECT_NE(line.find("23.8 ms"), std::string::npos) << line;
  EXPECT_NE(line.find("camera.readout: 0.0238 "), std::string::npos) << line;
}

TEST(ReadoutCheck, AConfiguredGlobalShutterIsBelieved) { EXPECT_EQ(readoutLine(0, true, 0.0238), ""); }

TEST(ReadoutCheck, ADriverThatDoesNotTellIsNotAsked) {
  for (const double used : {0.0, 0.02, -0.02}) EXPECT_EQ(readoutLine(used, false, 0), "");
}

TEST(ReadoutCheck, ADifferenceOfMoreThanAFifthIsTold) {
  for (const bool is_configured : {false, true}) {
    for (const double sign : {1.0, -1.0}) {  // the driver does not tell which row is first
      EXPECT_EQ(readoutLine(sign * 0.0205, is_configured, 0.025), "");
      EXPECT_EQ(readoutLine(sign * 0.0295, is_configured, 0.025), "");
      EXPECT_NE(readoutLine(sign * 0.0195, is_configured, 0.025), "");
      EXPECT_NE(readoutLine(sign * 0.0305, is_configured, 0.025), "");
    }
  }
  const std::string line = readoutLine(0.02, false, 0.03);
  EXPECT_NE(line.find("20.0 ms"), std::string::npos) << line;
  EXPECT_NE(line.find("30.0 ms"), std::string::npos) << line;
}

}  // namespace
}  // namespace edgeslam
