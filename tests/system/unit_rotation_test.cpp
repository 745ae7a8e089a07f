// An inertial unit that is turned a little otherwise than was given is found on the way, told, and used from then on.
#include <gtest/gtest.h>

#include "frames/inertial_file.h"
#include "geometry/angles.h"
#include "system/measured_beside.h"

namespace edgeslam {
namespace {

class UnitRotation : public MeasuredBesideTest {
 protected:
  UnitRotation() : MeasuredBesideTest("swinging"), unit_(readInertialUnit(input_ + "/imu.yaml")) {}

  // The sequence with another rotation in its file than the right one, by a vector in the camera's frame [degrees].
  std::string sequenceTurnedBy(const Eigen::Vector3d& degrees_wrong) const {
    const Eigen::Quaterniond q = unit_.imu_T_camera.rotation * rotationExp(radians(1) * degrees_wrong);
    std::ostringstream given;
    given.precision(9);
    given << "quaternion: [" << q.w() << ", " << q.x() << ", " << q.y() << ", " << q.z() << "]";
    std::string unit = fileContent(input_ + "/imu.yaml");
    const std::size_t begin = unit.find("quaternion: ["), end = unit.find(']', begin);
    unit.replace(begin, end + 1 - begin, given.str());
    return sequenceWithUnit("turned" + std::to_string(sequences_++), unit);
  }

  const InertialUnit unit_;
  mutable int sequences_ = 0;
};

TEST_F(UnitRotation, GivenWronglyIsFound) {
  runOver(sequenceTurnedBy({0, 0, 0}), "right");
  const AbsoluteError right = errorOf("right");
  for (const Eigen::Vector3d& wrong : {Eigen::Vector3d(2, 0, 0), Eigen::Vector3d(0, 0, -1.5)}) {
    const ReplayedRun run = runOver(sequenceTurnedBy(wrong), "run");
    const nlohmann::json& found = run.summary["imu_rotation"];
    ASSERT_TRUE(found.is_object()) << run.outcome.output;
    const nlohmann::json& q = found["quaternion"];
    const Eigen::Quaterniond rotation(q[0].get<double>(), q[1].get<double>(), q[2].get<double>(), q[3].get<double>());
    const double sigma_deg = found["sigma_deg"].get<double>(),
                 error_deg = degrees(rotationAngle(rotation, unit_.imu_T_camera.rotation));
    EXPECT_LT(error_deg, 0.5);
    EXPECT_LT(sigma_deg, 0.8);
    EXPECT_LT(error_deg, 3 * sigma_deg);
    EXPECT_NE(run.outcome.output.find("found on the way: how the inertial unit is turned"), std::string::npos)
        << run.outcome.output;
    EXPECT_NE(run.outcome.output.find("against what imu_T_camera says: with quaternion"), std::string::npos)
        << run.outcome.output;
    const AbsoluteError error = errorOf("run");
    EXPECT_LT(error.translation.rmse, 1.2 * right.translation.rmse + 0.0005);
    EXPECT_NEAR(error.reference_T_estimate.scale, 1, 0.015);
    const Eigen::Vector3d up = error.reference_T_estimate.rotation * Eigen::Vector3d::UnitZ();
    EXPECT_LT(degrees(std::acos(up.z())), 0.5) << "the world's z is not up";
    std::filesystem::remove_all(folder_.path("run"));
  }
}

TEST_F(UnitRotation, ThatIsRightStays) {
  const ReplayedRun run = runOver(input_, "right");
  EXPECT_TRUE(run.summary["imu_rotation"].is_null()) << run.summary["imu_rotation"];
  EXPECT_EQ(run.outcome.output.find("is turned"), std::string::npos) << run.outcome.output;
}

TEST_F(UnitRotation, ThatIsFarOffIsToldAndNotUsed) {
  const ReplayedRun run = runOver(sequenceTurnedBy({0, 9, 0}), "far");
  EXPECT_TRUE(run.summary["imu_rotation"].is_null()) << run.summary["imu_rotation"];
  EXPECT_NE(run.outcome.output.find("seems to be turned by"), std::string::npos) << run.outcome.output;
  EXPECT_NE(run.outcome.output.find("lengths are map units: inertia: the unit seems to be turned otherwise"),
            std::string::npos)
      << run.outcome.output;
}

TEST_F(UnitRotation, IsFoundInTheSameBytesTwice) {
  const std::string sequence = sequenceTurnedBy({2, 0, 0});
  runOver(sequence, "once");
  runOver(sequence, "twice");
  expectSameBytes("once", "twice");
}

TEST_F(UnitRotation, IsFoundAgainWhereARecordingRepeatsALiveRun) {
  const ReplayedRun live =
      runOver(sequenceTurnedBy({2, 0, 0}), "live", {"--imu", "--realtime", "--record", folder_.path("recording")});
  ASSERT_TRUE(live.summary["imu_rotation"].is_object()) << live.outcome.output;
  const ReplayedRun again = runOver(folder_.path("recording"), "again", {});
  EXPECT_EQ(live.summary["imu_rotation"], again.summary["imu_rotation"]);
  expectSameBytes("live", "again");
}

}  // namespace
}  // namespace edgeslam
