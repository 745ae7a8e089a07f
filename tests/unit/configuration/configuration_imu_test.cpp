#include <gtest/gtest.h>

#include "configuration/configuration.h"
#include "configuration/configuration_text.h"
#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

const std::string mounting_text = "imu_T_camera: {translation: [0.01, -0.02, 0.03], quaternion: [0.5, 0.5, -0.5, 0.5]}";

Configuration configurationWithUnits(const std::string& text) {
  const TemporaryFolder folder;
  folder.write("units/known.yaml", mounting_text + "\ngyroscope_noise_density: 0.004\ntime_offset_s: -0.005\n");
  folder.write("units/rolling.yaml", mounting_text + "\nreadout_s: 0.024\n");
  folder.write("units/bad.yaml", mounting_text + "\ngyroscope_noise_density: -1\n");
  return readConfiguration(folder.write("file.yaml", text));
}

void expectUnitRefused(const std::string& text, const std::string& part) {
  try {
    settingsWithSensors(configurationWithUnits(text));
    ADD_FAILURE() << "not refused: " << text;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

void expectTheKnownUnit(const Configuration& read) {
  const InertialUnit& unit = read.inertia.unit;
  EXPECT_TRUE(read.inertia.has_unit);
  EXPECT_EQ(unit.imu_T_camera.translation, Eigen::Vector3d(0.01, -0.02, 0.03));
  EXPECT_EQ(unit.imu_T_camera.rotation.coeffs(), Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5).coeffs());
  EXPECT_EQ(unit.rate_noise, 0.004);
  EXPECT_EQ(unit.force_noise, InertialUnit().force_noise);
  EXPECT_EQ(unit.offset_ns, -5'000'000);
}

TEST(ConfigurationImu, IsNotUsedUnlessAskedFor) {
  const Configuration read = configurationWithUnits("imu: {" + mounting_text + "}\n");
  EXPECT_FALSE(read.inertia.is_used);
  EXPECT_FALSE(settingsWithSensors(read).tracking.inertia);
  EXPECT_FALSE(settingsWithSensors(configurationWithUnits("")).tracking.inertia);
}

TEST(ConfigurationImu, ReadsAnInlineUnitAndAFile) {
  expectTheKnownUnit(
      configurationWithUnits("imu: {" + mounting_text + ", gyroscope_noise_density: 0.004, time_offset_s: -0.005}\n"));
  expectTheKnownUnit(configurationWithUnits("imu: {calibration: units/known.yaml, enabled: true}\n"));
}

TEST(ConfigurationImu, AUsedUnitIsInTheSettings) {
  const Settings settings =
      settingsWithSensors(configurationWithUnits("imu: {enabled: true, calibration: units/known.yaml}\n"));
  ASSERT_TRUE(settings.tracking.inertia);
  EXPECT_EQ(settings.tracking.inertia->rate_noise, 0.004);
  EXPECT_TRUE(settings.mapping.local_adjustment.inertia);
}

TEST(ConfigurationImu, TheReadoutFoundWithTheUnitIsTheCamerasWhereItsCalibrationHasNone) {
  Configuration with = configurationWithUnits("imu: {enabled: true, calibration: units/rolling.yaml}\n");
  Camera camera;
  EXPECT_EQ(withReadoutOfUnit(camera, with).readout_s, 0.024);
  with.has_readout = true;
  EXPECT_EQ(withReadoutOfUnit(camera, with).readout_s, 0) << "the configuration says: a global shutter";
  with.has_readout = false;
  camera.readout_s = -0.01;
  EXPECT_EQ(withReadoutOfUnit(camera, with).readout_s, -0.01);
  camera.readout_s = 0;
  with.inertia.is_used = false;
  EXPECT_EQ(withReadoutOfUnit(camera, with).readout_s, 0);
}

TEST(ConfigurationImu, WhatCannotBeIsRefused) {
  expectUnitRefused("imu: {enabled: true}\n", "imu.imu_T_camera");
  expectUnitRefused("imu: {calibration: units/none.yaml}\n", "imu.calibration: ");
  expectUnitRefused("imu: {calibration: units/bad.yaml}\n", "gyroscope_noise_density");
  expectUnitRefused("imu: {calibration: [1]}\n", "the path of a file");
  expectUnitRefused("imu: {calibration: units/known.yaml, time_offset_s: 1}\n", "in a file already");
  expectUnitRefused("imu: {imu_T_camera: [1, 2, 3]}\n", "16 finite numbers");
  expectUnitRefused("imu: {time_offset_s: 1000}\n", "-10 to 10 s");
  expectUnitRefused("imu: {channel: SLAM_POSE}\n", "named twice");
  expectUnitRefused("imu: {channel: \"\"}\n", "imu.channel: a text");
}

TEST(ConfigurationImu, IsWrittenSoThatItReadsBackToTheLastBit) {
  Configuration before;
  before.inertia.is_used = before.inertia.has_unit = true;
  before.inertia.unit.imu_T_camera = {Eigen::Quaterniond(1, 2, 3, 4).normalized(), {0.1 / 3, 1e-17, -7}};
  before.inertia.unit.rate_noise = 1e-3 / 7;
  before.inertia.unit.offset_ns = -123'456'789;
  const Configuration after = configurationWithUnits(formatConfiguration(before));
  EXPECT_EQ(after.inertia.unit.imu_T_camera.rotation.coeffs(), before.inertia.unit.imu_T_camera.rotation.coeffs());
  EXPECT_EQ(after.inertia.unit.imu_T_camera.translation, before.inertia.unit.imu_T_camera.translation);
  EXPECT_EQ(after.inertia.unit.rate_noise, before.inertia.unit.rate_noise);
  EXPECT_EQ(after.inertia.unit.offset_ns, before.inertia.unit.offset_ns);
  EXPECT_TRUE(after.inertia.is_used && after.inertia.has_unit);
}

}  // namespace
}  // namespace edgeslam
