#include "app/cameras_command.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "configuration/configuration.h"
#include "unit/files/temporary_folder.h"
#include "unit/v4l2/fake_driver.h"

namespace edgeslam {
namespace {

class CamerasCommandTest : public testing::Test {
 protected:
  void SetUp() override {
    dev_.write("video0", "");
    dev_.write("v4l/by-id/x", "");
    std::filesystem::create_symlink("../../video0", dev_.path("v4l/by-id/usb-Maker-index0"));
    driver_.controls[V4L2_CID_GAIN] = {"Gain", V4L2_CTRL_TYPE_INTEGER, 0, 100, 1, 20, {}};
    driver_.formats.push_back({v4l2_fourcc('H', '2', '6', '4'), {}});
    listed_ = listV4l2Cameras(dev_.path(), driver_);
  }

  TemporaryFolder dev_;
  FakeDriver driver_;
  std::vector<ListedCamera> listed_;
};

TEST_F(CamerasCommandTest, TheConfigurationLinesThatItShowsAreGoodOnes) {
  const std::string text = camerasText(listed_, {});
  const std::size_t at = text.find("    capture:\n");
  ASSERT_NE(at, std::string::npos) << text;
  const TemporaryFolder folder;
  const CameraOptions options = readConfiguration(folder.write("a.yaml", text.substr(at))).capture;
  EXPECT_EQ(options.device, dev_.path("v4l/by-id/usb-Maker-index0"));
  EXPECT_EQ(options.format, "GREY");
  EXPECT_EQ(options.width, 64);
  EXPECT_EQ(options.height, 48);
}

TEST_F(CamerasCommandTest, FormatsRatesAndControlsAreShown) {
  const std::string text = camerasText(listed_, {});
  for (const char* part : {"YUYV 64 x 48 (30, 15 frames/s), 32 x 24 (60, 30 frames/s)", "H264 (cannot be used)",
                           "gain: 20 (0 to 100", "Fake"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  }
}

TEST_F(CamerasCommandTest, JsonTellsTheSame) {
  const nlohmann::json json = camerasJson(listed_, {});
  ASSERT_EQ(json["cameras"].size(), 1U);
  const nlohmann::json& camera = json["cameras"][0];
  EXPECT_EQ(camera["device"], dev_.path("v4l/by-id/usb-Maker-index0"));
  EXPECT_EQ(camera["formats"][0]["sizes"][1]["frame_rates"][0], 60);
  EXPECT_EQ(camera["formats"][2]["usable"], false);
  EXPECT_EQ(camera["controls"][0]["name"], "gain");
  EXPECT_EQ(camera["controls"][0]["value"], 20);
}

TEST_F(CamerasCommandTest, TheReadoutIsShownWhereTheDriverTellsIt) {
  EXPECT_EQ(camerasText(listed_, {}).find("readout"), std::string::npos);
  EXPECT_EQ(camerasJson(listed_, {})["cameras"][0].count("sensor"), 0U);
  driver_.own_numbers = {{V4L2_CID_PIXEL_RATE, 1'000'000}, {V4L2_CID_HBLANK, 136}};
  listed_ = listV4l2Cameras(dev_.path(), driver_);
  const std::string text = camerasText(listed_, {});
  for (const char* part : {"64 x 48 px", "over 9.4 ms", "camera.readout: 0.0094"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  }
  const nlohmann::json sensor = camerasJson(listed_, {})["cameras"][0]["sensor"];
  EXPECT_EQ(sensor["height"], 48);
  EXPECT_DOUBLE_EQ(sensor["readout_s"].get<double>(), 47 * 200e-6);
}

TEST(CamerasCommand, NoCameraIsToldAndSoIsAMissingLibcamera) {
  const std::string text = camerasText({}, {{}, "", "left out"});
  EXPECT_EQ(text, "no camera is there\nlibcamera: left out\n");
}

TEST(CamerasCommand, LibcamerasAreShownWithTheirConfiguration) {
  ListedLibcamera camera;
  camera.name = "/base/soc/i2c0mux/i2c@1/imx296@1a";
  camera.formats = {{"NV12", true, {{640, 480}}}, {"SBGGR10", false, {}}};
  camera.controls = {{"ExposureTime", "[29..15534385]"}};
  const std::string text = camerasText({}, {{camera}, "v0.0.3", ""});
  for (const char* part : {"device: libcamera:/base/soc/i2c0mux/i2c@1/imx296@1a", "NV12 640 x 480", "SBGGR10 (cannot",
                           "ExposureTime: [29..15534385]"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  }
}

}  // namespace
}  // namespace edgeslam
