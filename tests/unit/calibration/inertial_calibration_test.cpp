// The whole calibration of an inertial unit: what it finds, and what it refuses.
#include "calibration/inertial_calibration.h"

#include <gtest/gtest.h>

#include "calibration/inertial_calibration_text.h"
#include "frames/inertial_file.h"
#include "unit/files/temporary_folder.h"
#include "unit/inertia/turning_camera.h"

namespace edgeslam::test {
namespace {

InertialUnit mountedUnitOf(const TurningCamera& camera, double offset_s = 0) {
  InertialUnit unit;
  unit.rate_walk = camera.rate_walk;
  unit.offset_ns = std::llround(1e9 * offset_s);
  return unit;
}

InertialCalibration calibrated(const TurningCamera& camera, unsigned seed = 1) {
  return calibrateInertialUnit(camera.poses(seed), camera.samples(seed), mountedUnitOf(camera));
}

void expectRefused(const InertialCalibration& calibration, const std::string& because) {
  EXPECT_NE(calibration.problem.find(because), std::string::npos) << "says '" << calibration.problem << "'";
}

TEST(InertialCalibration, FindsTheUnitWithinThreeStandardDeviations) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    TurningCamera camera;
    camera.imu_R_camera = rotationExp(Eigen::Vector3d(0.5, -0.9, 0.7) * seed);
    camera.offset_s = 0.05 * seed - 0.2;
    const InertialCalibration found = calibrated(camera, seed);
    ASSERT_EQ(found.problem, "");
    EXPECT_EQ(found.unchecked, "");
    const TurnParameters& parameters = found.fit.parameters;
    const Eigen::Vector3d error = rotationLog((camera.imu_R_camera.conjugate() * parameters.imu_R_camera).normalized());
    EXPECT_LT(error.cwiseQuotient(rotationSigma(found.fit)).cwiseAbs().maxCoeff(), 3) << seed;
    EXPECT_LT((parameters.rate_bias - camera.rate_bias).cwiseQuotient(biasSigma(found.fit)).cwiseAbs().maxCoeff(), 3);
    EXPECT_LT(std::abs(parameters.offset_s - camera.offset_s), 3 * offsetSigma(found.fit)) << seed;
    EXPECT_LT(rotationSigma(found.fit).maxCoeff(), radians(0.1));
    EXPECT_LT(offsetSigma(found.fit), 5e-4);
  }
}

TEST(InertialCalibration, ACameraThatDoesNotTurnIsRefused) {
  TurningCamera camera;
  camera.swing_rad.setZero();
  expectRefused(calibrated(camera), "the camera hardly turns");
}

TEST(InertialCalibration, TurnsAboutOneAxisAreRefusedAndTheAxisIsNamed) {
  const std::vector<const char*> names{"its x axis (nodding)", "its y axis (turning left and right)",
                                       "its z axis (rolling"};
  for (int axis = 0; axis < 3; ++axis) {
    TurningCamera camera;
    camera.swing_rad = 0.4 * Eigen::Vector3d::Unit(axis);
    expectRefused(calibrated(camera),
                  std::string("turns about one axis only, ") + names[static_cast<std::size_t>(axis)]);
  }
}

TEST(InertialCalibration, PosesThatErrMoreThanTheCameraTurnsDoNotMakeUpForAnAxis) {
  TurningCamera camera;
  camera.swing_rad = {0, 0.4, 0};
  camera.pose_noise_rad = 0.01;
  EXPECT_NE(calibrated(camera).problem, "");
}

TEST(InertialCalibration, MirroredAxesAreRefused) {
  const TurningCamera camera;
  std::vector<InertialSample> swapped = camera.samples(1), negated = swapped;
  for (InertialSample& sample : swapped) std::swap(sample.rate.x(), sample.rate.y());
  for (InertialSample& sample : negated) sample.rate.z() *= -1;
  expectRefused(calibrateInertialUnit(camera.poses(1), swapped, mountedUnitOf(camera)), "mirror image");
  expectRefused(calibrateInertialUnit(camera.poses(1), negated, mountedUnitOf(camera)), "mirror image");
}

TEST(InertialCalibration, WhereAMirrorWouldNotBeNoticedItSaysSo) {
  TurningCamera camera;
  camera.swing_rad = {0.1, 0.12, 0};
  const InertialCalibration found = calibrated(camera);
  EXPECT_EQ(found.problem, "");
  EXPECT_NE(found.unchecked.find("hardly turns about its z axis"), std::string::npos) << found.unchecked;
}

TEST(InertialCalibration, ARecordingThatIsTooShortIsRefused) {
  TurningCamera camera;
  camera.seconds = 5;
  expectRefused(calibrated(camera), "s in common, 8 s are needed");
}

TEST(InertialCalibration, SamplesOfAnotherTimeOrOfAnotherUnitAreRefused) {
  TurningCamera camera, other;
  other.swing_rad = {0.3, 0.2, 0.25};
  std::vector<InertialSample> others = other.samples(1);
  for (std::size_t i = 0; i < others.size(); ++i) {
    // Of a motion of its own: forwards in time where the camera's goes backwards.
    if (i < others.size() / 2) std::swap(others[i].rate, others[others.size() - 1 - i].rate);
  }
  expectRefused(calibrateInertialUnit(camera.poses(1), others, mountedUnitOf(camera)),
                "contradicts the camera's turns");
  expectRefused(calibrateInertialUnit(camera.poses(1), camera.samples(1), mountedUnitOf(camera, 1000)),
                "too little time in common");
}

TEST(InertialCalibration, ClocksThatDifferByTooMuchAreRefused) {
  TurningCamera camera;
  camera.offset_s = 0.52;
  EXPECT_NE(calibrated(camera).problem, "");
  EXPECT_EQ(calibrateInertialUnit(camera.poses(1), camera.samples(1), mountedUnitOf(camera, 0.3)).problem, "");
}

TEST(InertialCalibration, ItsFileIsReadAsTheUnit) {
  const TurningCamera camera;
  const InertialCalibration found = calibrated(camera);
  KnownUnit known{mountedUnitOf(camera), true};
  known.unit.imu_T_camera.translation = {0.03, -0.01, 0.2};
  known.unit.rate_noise = 3e-4;
  known.unit.camera_readout_s = 0.02;
  const TemporaryFolder folder;
  folder.write("imu.yaml", inertialUnitText(known, found, "a\nb"));
  const InertialUnit unit = readInertialUnit(folder.path("imu.yaml"));
  EXPECT_LT(rotationAngle(unit.imu_T_camera.rotation, found.fit.parameters.imu_R_camera), 1e-5);
  EXPECT_EQ(unit.imu_T_camera.translation, known.unit.imu_T_camera.translation);
  EXPECT_NEAR(static_cast<double>(unit.offset_ns) * 1e-9, found.fit.parameters.offset_s, 1e-6);
  EXPECT_EQ(unit.rate_noise, 3e-4);
  EXPECT_EQ(unit.camera_readout_s, 0.02);
}

TEST(InertialCalibration, WhereNoPlaceWasGivenItsFileHasTheOneThatWasFound) {
  const TurningCamera camera;
  const InertialCalibration found = calibrated(camera);
  const KnownUnit known{mountedUnitOf(camera), false};
  EXPECT_NE(inertialSummary(known, found).find("none was given"), std::string::npos);
  const TemporaryFolder folder;
  folder.write("imu.yaml", inertialUnitText(known, found, "recording"));
  const InertialUnit unit = readInertialUnit(folder.path("imu.yaml"));
  EXPECT_LT((unit.imu_T_camera.translation - camera.imu_t_camera).norm(), 0.01);
}

}  // namespace
}  // namespace edgeslam::test
