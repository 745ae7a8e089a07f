#include "drivers/v4l2/sensor_rows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "drivers/v4l2/v4l2_camera.h"
#include "unit/v4l2/fake_driver.h"

namespace edgeslam {
namespace {

TEST(ReadoutOf, IsTheTimeFromTheFirstRowToTheLast) {
  EXPECT_NEAR(readoutOf(1080, 3448, 182.4e6), 1079 * 3448 / 182.4e6, 1e-12);
  EXPECT_DOUBLE_EQ(readoutOf(2, 1000, 1e6), 1e-3);
}

TEST(ReadoutOf, GrowsWithRowsAndLengthAndFallsWithTheRate) {
  const double readout = readoutOf(481, 1000, 48e6);
  EXPECT_DOUBLE_EQ(readoutOf(961, 1000, 48e6), 2 * readout);
  EXPECT_DOUBLE_EQ(readoutOf(481, 2000, 48e6), 2 * readout);
  EXPECT_DOUBLE_EQ(readoutOf(481, 1000, 96e6), readout / 2);
}

TEST(ReadoutOf, NumbersThatCannotBeTellNothing) {
  const double huge = std::numeric_limits<double>::max(), infinite = INFINITY, nan = std::nan("");
  for (const double bad : {0.0, -1.0, -huge, -infinite, nan}) {
    EXPECT_EQ(readoutOf(bad, 1000, 48e6), 0) << bad;
    EXPECT_EQ(readoutOf(480, bad, 48e6), 0) << bad;
    EXPECT_EQ(readoutOf(480, 1000, bad), 0) << bad;
  }
  for (const double bad : {huge, infinite}) {
    EXPECT_EQ(readoutOf(bad, 1000, 48e6), 0) << bad;
    EXPECT_EQ(readoutOf(480, bad, 48e6), 0) << bad;
    EXPECT_LT(readoutOf(480, 1000, bad), 1e-12) << bad;
  }
  EXPECT_EQ(readoutOf(1, 1000, 48e6), 0);
  EXPECT_GT(readoutOf(201, 1000, 1e6), 0.1999);
  EXPECT_EQ(readoutOf(202, 1000, 1e6), 0);  // more than a calibration may say
}

class SensorRowsTest : public testing::Test {
 protected:
  // A sensor, a bridge and the video device, in a row.
  void addSensor() {
    driver_.sensor_numbers = {{V4L2_CID_PIXEL_RATE, 1'000'000}, {V4L2_CID_HBLANK, 136}};
    driver_.entities = {entity(1, MEDIA_ENT_F_IO_V4L), entity(2, MEDIA_ENT_F_VID_IF_BRIDGE),
                        entity(3, MEDIA_ENT_F_CAM_SENSOR)};
    driver_.interfaces = {interface(11, MEDIA_INTF_T_V4L_VIDEO, 7), interface(13, MEDIA_INTF_T_V4L_SUBDEV, 9)};
    driver_.pads = {pad(21, 1), pad(22, 2), pad(23, 2), pad(24, 3)};
    driver_.links = {link(31, 11, 1, MEDIA_LNK_FL_INTERFACE_LINK), link(33, 13, 3, MEDIA_LNK_FL_INTERFACE_LINK),
                     link(34, 23, 21, MEDIA_LNK_FL_ENABLED), link(35, 24, 22, MEDIA_LNK_FL_ENABLED)};
  }
  static media_v2_entity entity(std::uint32_t id, std::uint32_t function) {
    media_v2_entity entity{};
    entity.id = id;
    entity.function = function;
    return entity;
  }
  static media_v2_interface interface(std::uint32_t id, std::uint32_t type, std::uint32_t minor) {
    media_v2_interface interface {};
    interface.id = id;
    interface.intf_type = type;
    interface.devnode.major = 81;
    interface.devnode.minor = minor;
    return interface;
  }
  static media_v2_pad pad(std::uint32_t id, std::uint32_t entity) {
    media_v2_pad pad{};
    pad.id = id;
    pad.entity_id = entity;
    return pad;
  }
  static media_v2_link link(std::uint32_t id, std::uint32_t source, std::uint32_t sink, std::uint32_t flags) {
    media_v2_link link{};
    link.id = id;
    link.source_id = source;
    link.sink_id = sink;
    link.flags = flags;
    return link;
  }

  // What a run is told of a camera of 64 x 48 px at 30 frames/s.
  double told() {
    CameraOptions options;
    options.device = "/dev/video7";
    const OpenedCamera opened = openV4l2Camera(options, driver_);
    EXPECT_TRUE(opened.camera) << opened.problem;
    EXPECT_EQ(driver_.open_files, 1);
    return opened.camera ? opened.camera->stream().readout_s : -1;
  }

  FakeDriver driver_;
};

constexpr double line_readout_s = 47 * 200e-6;  // rows of 64 + 136 pixels at 1 MHz

TEST_F(SensorRowsTest, ACameraThatTellsNothingHasNoReadout) { EXPECT_EQ(told(), 0); }

TEST_F(SensorRowsTest, ControlsOfTheVideoDeviceTellTheReadout) {
  driver_.own_numbers = {{V4L2_CID_PIXEL_RATE, 1'000'000}, {V4L2_CID_HBLANK, 136}};
  EXPECT_DOUBLE_EQ(told(), line_readout_s);
  driver_.own_numbers[V4L2_CID_PIXEL_RATE] = 5'000'000'000;  // more than 32 bits
  EXPECT_DOUBLE_EQ(told(), line_readout_s / 5000);
}

TEST_F(SensorRowsTest, ImagesThatAreCutOutOfTheSensorsDoNotTell) {
  driver_.own_numbers = {{V4L2_CID_PIXEL_RATE, 1'000'000}, {V4L2_CID_HBLANK, 136}};
  driver_.has_crop = true;
  EXPECT_EQ(told(), 0);
  driver_.crop = {0, 0, 64, 48};
  EXPECT_DOUBLE_EQ(told(), line_readout_s);
}

TEST_F(SensorRowsTest, ControlsOfTheSensorBehindTheVideoDeviceTellTheReadout) {
  addSensor();
  EXPECT_DOUBLE_EQ(told(), line_readout_s);
}

TEST_F(SensorRowsTest, ASensorOfAnotherSizeThanTheImagesTellsOnlyOfItself) {
  addSensor();
  driver_.sensor_height = 96;
  EXPECT_EQ(told(), 0);
  const OpenedDevice opened = openCaptureDevice(driver_, "/dev/video7");
  const std::optional<SensorRows> rows = sensorRows(*opened.device, {64, 48});
  ASSERT_TRUE(rows);
  EXPECT_EQ(rows->height, 96);
  EXPECT_DOUBLE_EQ(rows->readout_s, 95 * 200e-6);
}

TEST_F(SensorRowsTest, RowsThatTakeLongerThanAFrameAreNotBelieved) {
  addSensor();
  driver_.sensor_numbers[V4L2_CID_HBLANK] = 640;  // 33.1 ms of 33.3
  EXPECT_GT(told(), 0.033);
  driver_.sensor_numbers[V4L2_CID_HBLANK] = 700;
  EXPECT_EQ(told(), 0);
}

TEST_F(SensorRowsTest, ValuesThatCannotBeTellNothing) {
  addSensor();
  for (const std::uint32_t id : {V4L2_CID_PIXEL_RATE, V4L2_CID_HBLANK}) {
    const auto good = driver_.sensor_numbers;
    for (const std::int64_t bad : {std::int64_t{0}, std::int64_t{-1}, std::int64_t{INT32_MIN}}) {
      driver_.sensor_numbers[id] = bad;
      EXPECT_EQ(told(), 0) << id << " " << bad;
    }
    driver_.sensor_numbers.erase(id);
    EXPECT_EQ(told(), 0) << id;
    driver_.sensor_numbers = good;
  }
  for (const std::uint32_t bad : {0U, 1U, 65537U, UINT32_MAX}) {
    driver_.sensor_height = bad;
    EXPECT_EQ(told(), 0) << bad;
  }
}

TEST_F(SensorRowsTest, ASensorThatIsNotTheCamerasIsNotAsked) {
  const auto expectNothingWith = [&](const std::function<void()>& change) {
    addSensor();
    change();
    EXPECT_EQ(told(), 0);
  };
  expectNothingWith([&] { driver_.links[3].flags = 0; });               // not linked now
  expectNothingWith([&] { driver_.links[0].sink_id = 99; });            // of no entity
  expectNothingWith([&] { driver_.interfaces[0].devnode.minor = 8; });  // of another video device
  expectNothingWith([&] { driver_.interfaces.pop_back(); });            // a sensor without a file
  expectNothingWith([&] { driver_.entities[2].function = MEDIA_ENT_F_LENS; });
  expectNothingWith([&] { driver_.pads.clear(); });
  expectNothingWith([&] { driver_.pads.resize(5000, pad(99, 99)); });  // a driver gone wrong
  expectNothingWith([&] {                                              // two sensors
    driver_.entities.push_back(entity(4, MEDIA_ENT_F_CAM_SENSOR));
    driver_.pads.push_back(pad(25, 4));
    driver_.links.push_back(link(36, 25, 22, MEDIA_LNK_FL_ENABLED));
  });
}

// As all devices of the media device are that have no file.
TEST_F(SensorRowsTest, AVideoDeviceWithoutANumberHasNoSensor) {
  addSensor();
  driver_.device_number = 0;
  driver_.interfaces[0].devnode = {};
  EXPECT_EQ(told(), 0);
}

TEST_F(SensorRowsTest, LinksInACircleEnd) {
  addSensor();
  driver_.links.push_back(link(36, 22, 23, MEDIA_LNK_FL_ENABLED));
  driver_.links.push_back(link(37, 21, 24, MEDIA_LNK_FL_ENABLED));
  EXPECT_DOUBLE_EQ(told(), line_readout_s);
}

TEST_F(SensorRowsTest, FailuresTellNothing) {
  for (const unsigned long request : {MEDIA_IOC_G_TOPOLOGY, VIDIOC_SUBDEV_G_FMT}) {
    addSensor();
    driver_.failures[request] = {EIO};
    EXPECT_EQ(told(), 0) << request;
  }
  driver_.failures[MEDIA_IOC_G_TOPOLOGY] = {0, ENOSPC};  // parts came since they were counted
  EXPECT_EQ(told(), 0);
}

TEST(SystemCalls, ADeviceFileHasItsNumber) {
  const Device null(kernel(), kernel().openFile("/dev/null"));
  EXPECT_EQ(kernel().deviceNumber(null.descriptor()), makedev(1, 3));
  EXPECT_EQ(kernel().deviceNumber(-1), 0U);
}

}  // namespace
}  // namespace edgeslam
