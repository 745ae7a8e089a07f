// An offset of the inertial unit's clock that was given wrongly is found on the way, told, and used from then on.
#include <gtest/gtest.h>

#include "system/measured_beside.h"

namespace edgeslam {
namespace {

constexpr double largest_offset_error_s = 0.003;

class TimeOffset : public MeasuredBesideTest {
 protected:
  TimeOffset() : MeasuredBesideTest("swinging") {}

  // The sequence with another offset in its file than the right one, which is 0.
  std::string sequenceWith(double given_s) const {
    return sequenceWithUnit("given" + std::to_string(std::lround(1e3 * given_s)),
                            fileContent(input_ + "/imu.yaml") + "time_offset_s: " + std::to_string(given_s) + "\n");
  }
};

TEST_F(TimeOffset, GivenWronglyIsFound) {
  runOver(input_, "right");
  const AbsoluteError right = errorOf("right");
  for (const double given_s : {0.03, -0.04}) {
    const ReplayedRun run = runOver(sequenceWith(given_s), "run");
    const nlohmann::json& found = run.summary["imu_time_offset"];
    ASSERT_TRUE(found.is_object()) << run.outcome.output;
    EXPECT_NEAR(found["time_offset_s"].get<double>(), 0, largest_offset_error_s);
    EXPECT_LT(found["sigma_s"].get<double>(), 0.002);
    EXPECT_NE(run.outcome.output.find("found on the way: the inertial unit's clock differs by"), std::string::npos)
        << run.outcome.output;
    EXPECT_NE(run.outcome.output.find("this is known from the start"), std::string::npos) << run.outcome.output;
    const AbsoluteError error = errorOf("run");
    EXPECT_LT(error.translation.rmse, 1.2 * right.translation.rmse + 0.0005);
    EXPECT_NEAR(error.reference_T_estimate.scale, 1, 0.01);
    std::filesystem::remove_all(folder_.path("run"));
  }
}

TEST_F(TimeOffset, ThatIsRightStays) {
  const ReplayedRun run = runOver(input_, "right");
  EXPECT_TRUE(run.summary["imu_time_offset"].is_null()) << run.summary["imu_time_offset"];
  EXPECT_EQ(run.outcome.output.find("clock differs"), std::string::npos) << run.outcome.output;
}

TEST_F(TimeOffset, IsFoundInTheSameBytesTwice) {
  const std::string sequence = sequenceWith(0.03);
  runOver(sequence, "once");
  runOver(sequence, "twice");
  expectSameBytes("once", "twice");
}

TEST_F(TimeOffset, IsFoundAgainWhereARecordingRepeatsALiveRun) {
  const ReplayedRun live =
      runOver(sequenceWith(0.03), "live", {"--imu", "--realtime", "--record", folder_.path("recording")});
  ASSERT_TRUE(live.summary["imu_time_offset"].is_object()) << live.outcome.output;
  const ReplayedRun again = runOver(folder_.path("recording"), "again", {});
  EXPECT_EQ(live.summary["imu_time_offset"], again.summary["imu_time_offset"]);
  expectSameBytes("live", "again");
}

}  // namespace
}  // namespace edgeslam
