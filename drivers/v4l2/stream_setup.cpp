#include "drivers/v4l2/stream_setup.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <optional>
#include <vector>

#include "drivers/v4l2/offered_formats.h"

namespace edgeslam {
namespace {

constexpr double usual_rate = 30;  // [1/s]

// The parts of v4l2_format that matter, whether single- or multi-planar.
struct ImageFormat {
  std::uint32_t code = 0;
  std::uint32_t width = 0, height = 0, stride = 0;
};

v4l2_format packed(const CaptureDevice& device, const ImageFormat& image) {
  v4l2_format format{};
  format.type = device.bufferType();
  if (device.multi_planar) {
    format.fmt.pix_mp.pixelformat = image.code;
    format.fmt.pix_mp.width = image.width;
    format.fmt.pix_mp.height = image.height;
    format.fmt.pix_mp.field = V4L2_FIELD_NONE;
    format.fmt.pix_mp.num_planes = 1;
  } else {
    format.fmt.pix.pixelformat = image.code;
    format.fmt.pix.width = image.width;
    format.fmt.pix.height = image.height;
    format.fmt.pix.field = V4L2_FIELD_NONE;
  }
  return format;
}

ImageFormat unpacked(const CaptureDevice& device, const v4l2_format& format) {
  if (device.multi_planar) {
    const v4l2_pix_format_mplane& pixels = format.fmt.pix_mp;
    return {pixels.pixelformat, pixels.width, pixels.height, pixels.plane_fmt[0].bytesperline};
  }
  const v4l2_pix_format& pixels = format.fmt.pix;
  return {pixels.pixelformat, pixels.width, pixels.height, pixels.bytesperline};
}

// 0 or a negative errno. `image` becomes what the driver made of it.
int setFormat(const CaptureDevice& device, ImageFormat& image) {
  v4l2_format format = packed(device, image);
  const int error = device.device.control(VIDIOC_S_FMT, &format);
  if (error == 0) image = unpacked(device, format);
  return error;
}

int readFormat(const CaptureDevice& device, ImageFormat& image) {
  v4l2_format format{};
  format.type = device.bufferType();
  const int error = device.device.control(VIDIOC_G_FMT, &format);
  if (error == 0) image = unpacked(device, format);
  return error;
}

double rateOf(const v4l2_streamparm& parameters) {
  const v4l2_fract& interval = parameters.parm.capture.timeperframe;
  return interval.numerator == 0 ? 0 : static_cast<double>(interval.denominator) / interval.numerator;
}

// The rate that the driver then has; 0 where it does not tell.
double setRate(const CaptureDevice& device, double rate) {
  v4l2_streamparm parameters{};
  parameters.type = device.bufferType();
  if (device.device.control(VIDIOC_G_PARM, &parameters) < 0) return 0;
  if ((parameters.parm.capture.capability & V4L2_CAP_TIMEPERFRAME) == 0) return rateOf(parameters);
  parameters.parm.capture.timeperframe.numerator = 1000;
  parameters.parm.capture.timeperframe.denominator = static_cast<std::uint32_t>(std::lround(1000 * rate));
  if (device.device.control(VIDIOC_S_PARM, &parameters) < 0) return 0;
  return rateOf(parameters);
}

V4l2Problem setRegion(const CaptureDevice& device, const cv::Rect& region) {
  v4l2_selection selection{};
  selection.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;  // for multi-planar devices, too
  selection.target = V4L2_SEL_TGT_CROP;
  selection.r = {region.x, region.y, static_cast<std::uint32_t>(region.width),
                 static_cast<std::uint32_t>(region.height)};
  const auto text = [](const v4l2_rect& r) {
    return "[" + std::to_string(r.left) + ", " + std::to_string(r.top) + ", " + std::to_string(r.width) + ", " +
           std::to_string(r.height) + "]";
  };
  v4l2_selection bounds = selection;
  bounds.target = V4L2_SEL_TGT_CROP_BOUNDS;
  const bool has_bounds = device.device.control(VIDIOC_G_SELECTION, &bounds) == 0;
  const std::string allowed = has_bounds ? "; allowed is a region in " + text(bounds.r) : "";
  const std::string asked = device.path + ": region " + text(selection.r);
  if (const int error = device.device.control(VIDIOC_S_SELECTION, &selection); error < 0) {
    if (error == -ENOTTY) return {asked + ": this camera has no choice of a region", false};
    return {asked + " is refused: " + errorText(error) + allowed, mayHeal(error)};
  }
  if (cv::Rect(selection.r.left, selection.r.top, static_cast<int>(selection.r.width),
               static_cast<int>(selection.r.height)) != region) {
    return {asked + " is refused, the camera would take " + text(selection.r) + allowed, false};
  }
  return {};
}

// The fastest up to 30/s of the rates, which fall; 30/s where there are none.
double bestRate(const std::vector<double>& rates) {
  const auto best =
      std::find_if(rates.begin(), rates.end(), [](double rate) { return rate <= usual_rate * (1 + rate_tolerance); });
  if (best != rates.end()) return *best;
  return rates.empty() ? usual_rate : rates.back();
}

std::string sizeText(std::uint32_t width, std::uint32_t height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

// Asks for one format at the size wanted; no problem where the driver took it all.
SettledStream tryFormat(const CaptureDevice& device, const CameraOptions& options, const OfferedFormat& format,
                        const ImageFormat& wanted, const std::string& offers) {
  ImageFormat image = wanted;
  image.code = format.code;
  const std::string asked = device.path + ": " + format.name + " " + sizeText(wanted.width, wanted.height);
  if (const int error = setFormat(device, image); error < 0) {
    return {{}, {asked + " is refused: " + errorText(error), mayHeal(error)}};
  }
  if (image.code != format.code || image.width != wanted.width || image.height != wanted.height) {
    return {{}, {asked + " is refused, the camera would give " + sizeText(image.width, image.height) + offers, false}};
  }
  const std::vector<double> rates =
      offeredRates(device, format.code, static_cast<int>(image.width), static_cast<int>(image.height));
  const double rate = options.frame_rate > 0 ? options.frame_rate : bestRate(rates);
  const double given = setRate(device, rate);
  if (options.frame_rate > 0 && given > 0 && std::abs(given - rate) > rate_tolerance * rate) {
    return {{},
            {asked + " at " + rateText(rate) + " frames/s is refused, the camera would give " + rateText(given) +
                 " frames/s" + (rates.empty() ? "" : "; it offers " + listRates(rates) + " frames/s"),
             false}};
  }
  // Some drivers change the size with the rate.
  ImageFormat settled;
  if (readFormat(device, settled) == 0 && settled.width == wanted.width && settled.height == wanted.height &&
      settled.code == format.code) {
    image = settled;
  }
  SettledStream stream;
  stream.setup.layout = {*format.format, static_cast<int>(image.width), static_cast<int>(image.height), image.stride};
  stream.setup.frame_rate = given;
  return stream;
}

std::vector<OfferedFormat> formatsToTry(const std::vector<OfferedFormat>& offered, const std::string& wanted) {
  std::vector<OfferedFormat> formats;
  for (const PixelFormat known : pixel_formats) {
    if (!wanted.empty() && wanted != pixelFormatName(known)) continue;
    for (const OfferedFormat& format : offered) {
      if (format.format == known) formats.push_back(format);
    }
  }
  return formats;
}

}  // namespace

SettledStream settleStream(const CaptureDevice& device, const CameraOptions& options) {
  if (!options.region.empty()) {
    if (const V4l2Problem problem = setRegion(device, options.region); !problem.text.empty()) return {{}, problem};
  }
  ImageFormat wanted;
  if (const int error = readFormat(device, wanted); error < 0) {
    // v4l2loopback answers EINVAL as long as nobody feeds it.
    return {{}, {device.path + ": tells no format: " + errorText(error), error == -EINVAL || mayHeal(error)}};
  }
  if (options.width > 0) wanted.width = static_cast<std::uint32_t>(options.width);
  if (options.height > 0) wanted.height = static_cast<std::uint32_t>(options.height);

  const std::vector<OfferedFormat> offered = offeredFormats(device);
  const std::string offers = "; it offers " + listSizes(offered);
  const std::vector<OfferedFormat> formats = formatsToTry(offered, options.format);
  if (formats.empty()) {
    return {
        {},
        {device.path + ": has no format " + (options.format.empty() ? "that is known here" : options.format) + offers,
         false}};
  }
  SettledStream best;
  std::optional<std::size_t> best_format;
  V4l2Problem first_problem;
  for (std::size_t i = 0; i < formats.size(); ++i) {
    const SettledStream tried = tryFormat(device, options, formats[i], wanted, offers);
    if (!tried.problem.text.empty()) {
      if (first_problem.text.empty()) first_problem = tried.problem;
      continue;
    }
    const bool faster = tried.setup.frame_rate > best.setup.frame_rate * (1 + rate_tolerance);
    if (!best_format || faster) {
      best = tried;
      best_format = i;
    }
    if (options.frame_rate > 0 || best.setup.frame_rate >= usual_rate * (1 - rate_tolerance)) break;
  }
  if (!best_format) return {{}, first_problem};
  return tryFormat(device, options, formats[*best_format], wanted, offers);  // the last one tried may have been another
}

cv::Size presentSize(const CaptureDevice& device) {
  ImageFormat image;
  if (readFormat(device, image) < 0 || image.width > INT32_MAX || image.height > INT32_MAX) return {};
  return {static_cast<int>(image.width), static_cast<int>(image.height)};
}

}  // namespace edgeslam
