// Inertial data beside frames, and what is said of files that cannot be used.
#include "frames/inertial_file.h"

#include "frames/frame_source.h"
#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

const std::string samples_text =
    "# timestamp [s], gyro x y z [rad/s], accelerometer x y z [m/s^2]\n"
    "1000.010000, 0.1, 0.2, 0.3, 0.5, -0.25, 9.75\n"
    "1000.015000 0.1 0.2 0.3 0.5 -0.25 9.75\n"
    "1000020000000000,0.1,0.2,0.3,0.5,-0.25,9.75\n";

const std::string unit_text =
    "rate_hz: 200\nimu_T_camera: {translation: [0.03, -0.01, 0.006], quaternion: [0.5, -0.5, 0.5, -0.5]}\n"
    "gyroscope_noise_density: 0.0003\naccelerometer_random_walk: 0.004\ntime_offset_s: -0.0125\n";

std::vector<InertialSample> readSamples(const std::string& text) {
  const TemporaryFolder folder;
  return readInertialSamples(folder.write("imu.csv", text));
}

InertialUnit readUnit(const std::string& text) {
  const TemporaryFolder folder;
  return readInertialUnit(folder.write("imu.yaml", text));
}

template <typename... Texts>
void expectSamplesRefused(const std::string& text, const Texts&... messages) {
  SCOPED_TRACE(text);
  expectInputError([&] { readSamples(text); }, "imu.csv", messages...);
}

template <typename... Texts>
void expectUnitRefused(const std::string& text, const Texts&... messages) {
  SCOPED_TRACE(text);
  expectInputError([&] { readUnit(text); }, "imu.yaml", messages...);
}

TEST(InertialFile, ReadsSamples) {
  const std::vector<InertialSample> samples = readSamples(samples_text);
  ASSERT_EQ(samples.size(), 3U);
  EXPECT_EQ(samples[0].time_ns, 1000'010'000'000);
  EXPECT_EQ(samples[2].time_ns, 1000'020'000'000'000);
  EXPECT_EQ(samples[1].rate, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(samples[1].force, Eigen::Vector3d(0.5, -0.25, 9.75));
}

TEST(InertialFile, LeavesOutATornLine) {
  EXPECT_EQ(readSamples(samples_text + "1000.025 0.1 0.").size(), 3U);
  expectSamplesRefused(samples_text + "1000.025 0.1 0.\n", ":5: ", "7 columns");
}

TEST(InertialFile, SaysWhatIsWrongWithSamples) {
  expectSamplesRefused("", "no samples");
  expectSamplesRefused("1 2 3\n", ":1: ", "7 columns");
  expectSamplesRefused("1 0 0 nan 0 0 9.8\n", ":1: ");
  expectSamplesRefused("2 0 0 0 0 0 9.8\n1 0 0 0 0 0 9.8\n", ":2: ", "not after");
  expectSamplesRefused("1 0 0 0 0 0 9.8\n1 0 0 0 0 0 9.8\n", ":2: ", "not after");
  expectSamplesRefused("1 0 0 0 0 0 1\n", "multiples of g");
  expectSamplesRefused("1 0 0 0 0 0 9800\n", "9.8");
  expectSamplesRefused("1 0 0 50 0 0 9.8\n", "degrees");
}

TEST(InertialFile, ReadsAUnit) {
  const InertialUnit unit = readUnit(unit_text);
  EXPECT_EQ(unit.imu_T_camera.translation, Eigen::Vector3d(0.03, -0.01, 0.006));
  EXPECT_EQ(unit.imu_T_camera.rotation.y(), 0.5);
  EXPECT_EQ(unit.rate_noise, 0.0003);
  EXPECT_EQ(unit.force_walk, 0.004);
  EXPECT_EQ(unit.force_noise, InertialUnit().force_noise);
  EXPECT_EQ(unit.offset_ns, -12'500'000);
}

TEST(InertialFile, SaysWhatIsWrongWithAUnit) {
  expectUnitRefused("rate_hz: 200\n", "'imu_T_camera' is missing");
  expectUnitRefused("imu_T_camera: {translation: [0, 0], quaternion: [1, 0, 0, 0]}\n", ":1: ", "3 numbers");
  expectUnitRefused("imu_T_camera: {translation: [0, 0, 0], quaternion: [1, 1, 0, 0]}\n", "length 1");
  expectUnitRefused(unit_text + "gyroscope_noise_densty: 1\n", ":6: ", "unknown key", "gyroscope_noise_density");
  expectUnitRefused("accelerometer_noise_density: -1\n" + unit_text, ":1: ", "greater than 0");
  expectUnitRefused("imu_T_camera: [1\n", "YAML");
  expectUnitRefused(unit_text + "readout_s: 24\n", ":6: ", "-0.2 to 0.2");
}

TEST(InertialFile, IsFoundBesideTheFrames) {
  const TemporaryFolder folder;
  folder.write("rgb.txt", "1000.01 a.png\n");
  EXPECT_EQ(openFrames(folder.path(""))->inertialFiles().samples, "");
  expectInputError([&] { readInertialRecording(openFrames(folder.path(""))->inertialFiles()); }, "imu.csv");
  folder.write("imu.csv", samples_text);
  expectInputError([&] { readInertialRecording(openFrames(folder.path(""))->inertialFiles()); }, "imu.yaml");
  folder.write("imu.yaml", unit_text);
  EXPECT_EQ(readInertialRecording(openFrames(folder.path(""))->inertialFiles()).samples.size(), 3U);
  EXPECT_EQ(readInertialRecording(openFrames(folder.path(""))->inertialFiles()).unit.camera_readout_s, 0);
  folder.write("imu.yaml", unit_text + "readout_s: 0.024\n");
  EXPECT_EQ(readInertialRecording(openFrames(folder.path(""))->inertialFiles()).unit.camera_readout_s, 0.024);
}

TEST(InertialFile, EurocsIsRead) {
  const TemporaryFolder folder;
  const auto sensor = [](const std::string& x) {
    return "sensor_type: imu\nT_BS:\n  cols: 4\n  rows: 4\n  data: [1, 0, 0, " + x +
           ", 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1]\ngyroscope_noise_density: 1.7e-4\n";
  };
  const InertialFiles files{folder.write("data.csv", "1403636579763555584,0.1,0.2,0.3,9.7,0.1,0.2\n"),
                            folder.write("imu_sensor.yaml", sensor("0.5")), folder.write("sensor.yaml", sensor("2"))};
  const InertialRecording recording = readInertialRecording(files);
  EXPECT_EQ(recording.samples.front().time_ns, 1403636579763555584);
  EXPECT_NEAR((recording.unit.imu_T_camera.translation - Eigen::Vector3d(1.5, 0, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR(recording.unit.imu_T_camera.rotation.w(), 1, 1e-12);
  EXPECT_EQ(recording.unit.rate_noise, 1.7e-4);
}

}  // namespace
}  // namespace edgeslam
