// What a device offers: pixel formats with their sizes and frame rates, as the driver lists them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/frame_capture/pixel_format.h"
#include "drivers/v4l2/capture_device.h"

namespace edgeslam {

struct OfferedSize {
  // Fixed where both are the same; otherwise anything between, in steps.
  int least_width = 0, least_height = 0;      // [px]
  int largest_width = 0, largest_height = 0;  // [px]
  int width_step = 1, height_step = 1;        // [px]
  std::vector<double> rates;  // [1/s] of the largest size, falling; empty where the driver does not tell

  bool holds(int width, int height) const;
};

struct OfferedFormat {
  std::uint32_t code = 0;             // four characters
  std::string name;                   // ours where we know it, otherwise its four characters
  std::optional<PixelFormat> format;  // empty: not one that can be turned to grey
  std::vector<OfferedSize> sizes;     // empty where the driver does not tell
};

// In the driver's order; a driver that lists without end is cut short.
std::vector<OfferedFormat> offeredFormats(const CaptureDevice& device);

// Frame rates at this size, falling; empty where the driver does not tell.
std::vector<double> offeredRates(const CaptureDevice& device, std::uint32_t code, int width, int height);

// "GREY 640 x 480 (30, 15 frames/s), 320 x 240 (30 frames/s)"; sizes beyond the first 40 are left out.
std::string listFormat(const OfferedFormat& format);

// The formats that can be used with their sizes, for messages: "GREY, YUYV 640 x 480, 320 x 240; MJPEG 640 x 480";
// those with the same sizes share them.
std::string listSizes(const std::vector<OfferedFormat>& formats);

// "640 x 480", "16 x 16 to 1920 x 1080".
std::string sizeText(const OfferedSize& size);
// "30, 15".
std::string listRates(const std::vector<double>& rates);
// "29.97", "30".
std::string rateText(double rate);

}  // namespace edgeslam
