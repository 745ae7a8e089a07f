#include "drivers/v4l2/sensor_rows.h"

#include <linux/v4l2-subdev.h>
#include <linux/videodev2.h>

#include "drivers/v4l2/sensor_device.h"

namespace edgeslam {
namespace {

constexpr double longest_readout_s = 0.2;  // of calibrations (geometry/camera.h)

// 0 where there is no such control.
std::int64_t controlValue(const Device& device, std::uint32_t id, bool is_wide) {
  v4l2_ext_control control{};
  control.id = id;
  v4l2_ext_controls controls{};
  controls.which = V4L2_CTRL_WHICH_CUR_VAL;
  controls.count = 1;
  controls.controls = &control;
  if (device.control(VIDIOC_G_EXT_CTRLS, &controls) < 0) return 0;
  return is_wide ? control.value64 : control.value;
}

// "Every line has length of the image width plus horizontal blanking at the pixel rate" (V4L2_CID_VBLANK).
double readoutOfSensor(const Device& sensor, cv::Size size) {
  const std::int64_t pixel_rate = controlValue(sensor, V4L2_CID_PIXEL_RATE, true);
  const std::int64_t blanking = controlValue(sensor, V4L2_CID_HBLANK, false);
  if (pixel_rate <= 0 || blanking <= 0 || size.empty()) return 0;
  return readoutOf(size.height, size.width + static_cast<double>(blanking), static_cast<double>(pixel_rate));
}

cv::Size sizeOf(std::uint32_t width, std::uint32_t height) {
  constexpr std::uint32_t largest = 65536;
  if (width > largest || height > largest) return {};
  return {static_cast<int>(width), static_cast<int>(height)};
}

cv::Size formatOf(const SensorDevice& sensor) {
  v4l2_subdev_format format{};
  format.which = V4L2_SUBDEV_FORMAT_ACTIVE;
  format.pad = sensor.pad;
  if (sensor.device.control(VIDIOC_SUBDEV_G_FMT, &format) < 0) return {};
  return sizeOf(format.format.width, format.format.height);
}

// What a video device cuts out of the sensor's images; `image` where it cuts nothing.
cv::Size regionOf(const CaptureDevice& device, cv::Size image) {
  v4l2_selection selection{};
  selection.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;  // for multi-planar devices, too
  selection.target = V4L2_SEL_TGT_CROP;
  if (device.device.control(VIDIOC_G_SELECTION, &selection) < 0) return image;
  return sizeOf(selection.r.width, selection.r.height);
}

}  // namespace

double readoutOf(double rows, double line_length, double pixel_rate) {
  if (!(rows >= 2) || !(line_length >= 1) || !(pixel_rate > 0)) return 0;
  const double readout_s = (rows - 1) * (line_length / pixel_rate);
  return readout_s <= longest_readout_s ? readout_s : 0;
}

std::optional<SensorRows> sensorRows(const CaptureDevice& device, cv::Size image) {
  cv::Size size = image;
  double readout_s = readoutOfSensor(device.device, size);
  if (readout_s > 0) {
    if (regionOf(device, image) != image) return std::nullopt;
  } else if (const std::optional<SensorDevice> sensor = openSensor(device)) {
    size = formatOf(*sensor);
    readout_s = readoutOfSensor(sensor->device, size);
  }
  if (readout_s == 0) return std::nullopt;
  return SensorRows{size.width, size.height, readout_s};
}

double readoutOfImages(const CaptureDevice& device, const StreamSetup& setup) {
  const std::optional<SensorRows> rows = sensorRows(device, {setup.layout.width, setup.layout.height});
  if (!rows || rows->width != setup.layout.width || rows->height != setup.layout.height) return 0;
  const bool fits = setup.frame_rate <= 0 || rows->readout_s * setup.frame_rate <= 1 + rate_tolerance;
  return fits ? rows->readout_s : 0;
}

}  // namespace edgeslam
