#include "drivers/v4l2/camera_controls.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <cctype>
#include <cstring>

namespace edgeslam {
namespace {

constexpr int most_controls = 512;
constexpr std::int64_t most_choices = 256;

std::string plainName(const char* bytes, std::size_t size) {
  std::string name;
  for (std::size_t i = 0; i < size && bytes[i] != '\0'; ++i) {
    const unsigned char c = static_cast<unsigned char>(bytes[i]);
    if (std::isalnum(c) != 0) {
      name += static_cast<char>(std::tolower(c));
    } else if (!name.empty() && name.back() != '_') {
      name += '_';
    }
  }
  while (!name.empty() && name.back() == '_') name.pop_back();
  return name;
}

bool isListed(std::uint32_t type) {
  return type == V4L2_CTRL_TYPE_INTEGER || type == V4L2_CTRL_TYPE_BOOLEAN || type == V4L2_CTRL_TYPE_MENU ||
         type == V4L2_CTRL_TYPE_INTEGER_MENU;
}

std::vector<ControlChoice> choicesOf(const CaptureDevice& device, const CameraControl& control) {
  std::vector<ControlChoice> choices;
  const std::int64_t last = std::min(control.largest, control.least + most_choices);
  for (std::int64_t i = std::max<std::int64_t>(control.least, 0); i <= last; ++i) {
    v4l2_querymenu entry{};
    entry.id = control.id;
    entry.index = static_cast<std::uint32_t>(i);
    if (device.device.control(VIDIOC_QUERYMENU, &entry) < 0) continue;  // left out of the menu
    if (control.type == V4L2_CTRL_TYPE_INTEGER_MENU) {
      choices.push_back({i, std::to_string(entry.value)});
    } else {
      const auto* const name = reinterpret_cast<const char*>(entry.name);
      choices.push_back({i, std::string(name, strnlen(name, sizeof entry.name))});
    }
  }
  return choices;
}

// 0 or a negative errno.
int readValue(const CaptureDevice& device, std::uint32_t id, std::int64_t& value) {
  v4l2_control control{};
  control.id = id;
  const int error = device.device.control(VIDIOC_G_CTRL, &control);
  if (error == 0) value = control.value;
  return error;
}

int writeValue(const CaptureDevice& device, std::uint32_t id, std::int64_t value) {
  v4l2_control control{};
  control.id = id;
  control.value = static_cast<std::int32_t>(value);
  return device.device.control(VIDIOC_S_CTRL, &control);
}

}  // namespace

std::vector<CameraControl> cameraControls(const CaptureDevice& device) {
  std::vector<CameraControl> controls;
  v4l2_queryctrl query{};
  for (int i = 0; i < most_controls; ++i) {
    const std::uint32_t last = query.id;
    query = {};
    query.id = last | V4L2_CTRL_FLAG_NEXT_CTRL;
    if (device.device.control(VIDIOC_QUERYCTRL, &query) < 0 || query.id <= last) break;
    if (!isListed(query.type) || (query.flags & V4L2_CTRL_FLAG_DISABLED) != 0) continue;
    CameraControl control;
    control.id = query.id;
    control.name = plainName(reinterpret_cast<const char*>(query.name), sizeof query.name);
    control.type = query.type;
    control.least = query.minimum;
    control.largest = query.maximum;
    control.step = std::max<std::int64_t>(query.step, 1);
    control.usual = query.default_value;
    control.read_only = (query.flags & V4L2_CTRL_FLAG_READ_ONLY) != 0;
    control.inactive = (query.flags & V4L2_CTRL_FLAG_INACTIVE) != 0;
    control.has_value =
        (query.flags & V4L2_CTRL_FLAG_WRITE_ONLY) == 0 && readValue(device, query.id, control.value) == 0;
    if (query.type == V4L2_CTRL_TYPE_MENU || query.type == V4L2_CTRL_TYPE_INTEGER_MENU) {
      control.choices = choicesOf(device, control);
    }
    controls.push_back(std::move(control));
  }
  return controls;
}

std::string allowedValues(const CameraControl& control) {
  if (control.type == V4L2_CTRL_TYPE_BOOLEAN) return "true or false";
  std::string text;
  for (const ControlChoice& choice : control.choices) {
    text += (text.empty() ? "" : ", ") + std::to_string(choice.value) + " (" + choice.name + ")";
  }
  if (!text.empty()) return text;
  text = std::to_string(control.least) + " to " + std::to_string(control.largest);
  return control.step == 1 ? text : text + " in steps of " + std::to_string(control.step);
}

std::int64_t fixedExposure(const CaptureDevice& device) {
  std::int64_t mode = 0, exposure = 0;
  const bool has_mode = readValue(device, V4L2_CID_EXPOSURE_AUTO, mode) == 0;
  if (has_mode && mode != V4L2_EXPOSURE_MANUAL && mode != V4L2_EXPOSURE_SHUTTER_PRIORITY) return 0;
  if (readValue(device, V4L2_CID_EXPOSURE_ABSOLUTE, exposure) < 0) return 0;
  return std::max<std::int64_t>(exposure, 0) * 100'000;
}

void keepFrameRate(const CaptureDevice& device) { writeValue(device, V4L2_CID_EXPOSURE_AUTO_PRIORITY, 0); }

}  // namespace edgeslam
