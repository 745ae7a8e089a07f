// An inertial unit that comes loose, and one whose samples are missing for a while: told, and the run goes on.
#include <gtest/gtest.h>

#include <iomanip>

#include "frames/inertial_file.h"
#include "geometry/angles.h"
#include "system/measured_beside.h"

namespace edgeslam {
namespace {

class TroubledUnit : public MeasuredBesideTest {
 protected:
  TroubledUnit() : MeasuredBesideTest("swinging"), samples_(readInertialSamples(input_ + "/imu.csv")) {}

  ReplayedRun runWith(const std::vector<InertialSample>& samples, const std::string& name) const {
    for (const char* file : {"rgb", "rgb.txt", "camera.yaml", "imu.yaml", "groundtruth.txt"}) {
      std::filesystem::create_symlink(input_ + "/" + file, folder_.path(file));
    }
    std::ostringstream lines;
    for (const InertialSample& sample : samples) {
      lines << std::fixed << std::setprecision(9) << 1e-9 * static_cast<double>(sample.time_ns);
      for (const Eigen::Vector3d& measured : {sample.rate, sample.force}) {
        for (const double value : measured) lines << ", " << value;
      }
      lines << "\n";
    }
    folder_.write("imu.csv", lines.str());
    ReplayedRun run = replayed(folder_.path(""), folder_.path(name), {"--imu"});
    EXPECT_EQ(run.outcome.exit_code, 0) << run.outcome.messages;
    return run;
  }

  std::vector<InertialSample> samples_;
};

// It swings by 2 degrees, three times a second.
TEST_F(TroubledUnit, ThatIsLooseIsToldAndTheCameraGoesOnAlone) {
  constexpr double angle = radians(2.0), pace = 2 * M_PI * 3;
  for (InertialSample& sample : samples_) {
    const double phase = pace * 1e-9 * static_cast<double>(sample.time_ns - samples_.front().time_ns);
    const Eigen::Quaterniond back = rotationExp({-angle * std::sin(phase), 0, 0});
    sample.rate = back * sample.rate + Eigen::Vector3d(angle * pace * std::cos(phase), 0, 0);
    sample.force = back * sample.force;
  }
  const ReplayedRun run = runWith(samples_, "loose");
  const std::string& said = run.outcome.output;
  const std::size_t first = said.find("the inertial unit moves against the camera in ");
  ASSERT_NE(first, std::string::npos) << said;
  EXPECT_EQ(said.find("the inertial unit moves against the camera in ", first + 1), std::string::npos) << said;
  EXPECT_NE(said.find("lengths are map units: inertia: the unit moves against the camera; is it loose?"),
            std::string::npos)
      << said;
  EXPECT_LT(errorOf("loose").translation.rmse, 0.005);
  EXPECT_GT(run.countGood(60, 399), 330);
}

TEST_F(TroubledUnit, WhoseSamplesAreMissingForAWhileIsTold) {
  const std::int64_t begin_ns = samples_.front().time_ns;
  const auto isMissing = [&](const InertialSample& sample) {
    const double time_s = 1e-9 * static_cast<double>(sample.time_ns - begin_ns);
    return (time_s > 6 && time_s < 6.2) || (time_s > 8 && time_s < 8.5);
  };
  samples_.erase(std::remove_if(samples_.begin(), samples_.end(), isMissing), samples_.end());
  const ReplayedRun run = runWith(samples_, "gaps");
  EXPECT_NE(run.outcome.messages.find("imu.csv: samples are missing: 2 gaps, 0.7"), std::string::npos)
      << run.outcome.messages;
  EXPECT_NE(run.outcome.output.find("lengths are metres"), std::string::npos) << run.outcome.output;
  EXPECT_EQ(run.outcome.output.find("is it loose"), std::string::npos) << run.outcome.output;
  const AbsoluteError error = errorOf("gaps");
  EXPECT_LT(error.translation.rmse, 0.005);
  EXPECT_NEAR(error.reference_T_estimate.scale, 1, 0.02);
}

TEST_F(TroubledUnit, ThatIsInOrderIsNotTold) {
  const ReplayedRun run = runWith(samples_, "good");
  EXPECT_EQ(run.outcome.messages.find("missing"), std::string::npos) << run.outcome.messages;
  EXPECT_EQ(run.outcome.output.find("is it loose"), std::string::npos) << run.outcome.output;
}

}  // namespace
}  // namespace edgeslam
