#include "drivers/v4l2/offered_formats.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "files/format_text.h"

namespace edgeslam {
namespace {

constexpr std::uint32_t most_entries = 256;  // of any list
constexpr std::size_t most_sizes = 40;       // in a text

int pixels(std::uint32_t count) { return static_cast<int>(std::min<std::uint32_t>(count, 1 << 20)); }

double rateOf(const v4l2_fract& interval) {
  if (interval.numerator == 0 || interval.denominator == 0) return 0;
  return static_cast<double>(interval.denominator) / interval.numerator;
}

std::string codeText(std::uint32_t code) {
  std::string text;
  for (int i = 0; i < 4; ++i) {
    const char c = static_cast<char>(code >> (8 * i) & 127);
    text += c >= 32 && c < 127 ? c : '?';
  }
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

std::vector<OfferedSize> offeredSizes(const CaptureDevice& device, std::uint32_t code) {
  std::vector<OfferedSize> sizes;
  for (std::uint32_t i = 0; i < most_entries; ++i) {
    v4l2_frmsizeenum entry{};
    entry.index = i;
    entry.pixel_format = code;
    if (device.device.control(VIDIOC_ENUM_FRAMESIZES, &entry) < 0) break;
    OfferedSize size;
    if (entry.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
      size.least_width = size.largest_width = pixels(entry.discrete.width);
      size.least_height = size.largest_height = pixels(entry.discrete.height);
    } else {
      size.least_width = pixels(entry.stepwise.min_width);
      size.least_height = pixels(entry.stepwise.min_height);
      size.largest_width = pixels(entry.stepwise.max_width);
      size.largest_height = pixels(entry.stepwise.max_height);
      size.width_step = std::max(pixels(entry.stepwise.step_width), 1);
      size.height_step = std::max(pixels(entry.stepwise.step_height), 1);
    }
    size.rates = offeredRates(device, code, size.largest_width, size.largest_height);
    sizes.push_back(size);
    if (entry.type != V4L2_FRMSIZE_TYPE_DISCRETE) break;  // the only entry
  }
  return sizes;
}

}  // namespace

bool OfferedSize::holds(int width, int height) const {
  return width >= least_width && height >= least_height && width <= largest_width && height <= largest_height &&
         (width - least_width) % width_step == 0 && (height - least_height) % height_step == 0;
}

std::vector<OfferedFormat> offeredFormats(const CaptureDevice& device) {
  std::vector<OfferedFormat> formats;
  for (std::uint32_t i = 0; i < most_entries; ++i) {
    v4l2_fmtdesc entry{};
    entry.index = i;
    entry.type = device.bufferType();
    if (device.device.control(VIDIOC_ENUM_FMT, &entry) < 0) break;
    OfferedFormat format;
    format.code = entry.pixelformat;
    format.format = pixelFormatOfCode(entry.pixelformat);
    format.name = format.format ? pixelFormatName(*format.format) : codeText(entry.pixelformat);
    format.sizes = offeredSizes(device, entry.pixelformat);
    formats.push_back(std::move(format));
  }
  return formats;
}

std::vector<double> offeredRates(const CaptureDevice& device, std::uint32_t code, int width, int height) {
  std::vector<double> rates;
  for (std::uint32_t i = 0; i < most_entries; ++i) {
    v4l2_frmivalenum entry{};
    entry.index = i;
    entry.pixel_format = code;
    entry.width = static_cast<std::uint32_t>(width);
    entry.height = static_cast<std::uint32_t>(height);
    if (device.device.control(VIDIOC_ENUM_FRAMEINTERVALS, &entry) < 0) break;
    if (entry.type == V4L2_FRMIVAL_TYPE_DISCRETE) {
      rates.push_back(rateOf(entry.discrete));
    } else {
      rates.push_back(rateOf(entry.stepwise.min));
      rates.push_back(rateOf(entry.stepwise.max));
      break;
    }
  }
  rates.erase(std::remove_if(rates.begin(), rates.end(), [](double rate) { return !(rate > 0); }), rates.end());
  std::sort(rates.begin(), rates.end(), std::greater<>());
  return rates;
}

std::string rateText(double rate) { return formatted("%.4g", rate); }

std::string sizeText(const OfferedSize& size) {
  std::string text = std::to_string(size.largest_width) + " x " + std::to_string(size.largest_height);
  if (size.least_width != size.largest_width || size.least_height != size.largest_height) {
    text = std::to_string(size.least_width) + " x " + std::to_string(size.least_height) + " to " + text;
  }
  return text;
}

std::string listFormat(const OfferedFormat& format) {
  std::string text = format.name;
  for (std::size_t i = 0; i < std::min(format.sizes.size(), most_sizes); ++i) {
    text += (i == 0 ? " " : ", ") + sizeText(format.sizes[i]);
    if (!format.sizes[i].rates.empty()) text += " (" + listRates(format.sizes[i].rates) + " frames/s)";
  }
  return format.sizes.size() > most_sizes ? text + ", ..." : text;
}

std::string listSizes(const std::vector<OfferedFormat>& formats) {
  std::vector<std::pair<std::string, std::string>> groups;  // sizes, formats
  for (const OfferedFormat& format : formats) {
    if (!format.format) continue;
    std::string sizes;
    for (std::size_t i = 0; i < std::min(format.sizes.size(), most_sizes); ++i) {
      sizes += (i == 0 ? " " : ", ") + sizeText(format.sizes[i]);
    }
    const auto group = std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.first == sizes; });
    if (group == groups.end()) {
      groups.emplace_back(sizes, format.name);
    } else {
      group->second += ", " + format.name;
    }
  }
  std::string text;
  for (const auto& [sizes, names] : groups) text += (text.empty() ? "" : "; ") + names + sizes;
  return text.empty() ? "none that is known here" : text;
}

std::string listRates(const std::vector<double>& rates) {
  std::string text;
  for (const double rate : rates) text += (text.empty() ? "" : ", ") + rateText(rate);
  return text;
}

}  // namespace edgeslam
