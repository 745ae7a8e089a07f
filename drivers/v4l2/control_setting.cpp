// A setting by its name and text to the control, or the two controls, that it means.
#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <optional>

#include "drivers/v4l2/camera_controls.h"
#include "files/text_file.h"

namespace edgeslam {
namespace {

using Controls = std::vector<CameraControl>;

const CameraControl* find(const Controls& controls, std::uint32_t id) {
  const auto found = std::find_if(controls.begin(), controls.end(), [&](const auto& c) { return c.id == id; });
  return found == controls.end() ? nullptr : &*found;
}

const CameraControl* findFirst(const Controls& controls, const std::vector<std::uint32_t>& ids) {
  for (const std::uint32_t id : ids) {
    if (const CameraControl* control = find(controls, id)) return control;
  }
  return nullptr;
}

// A name that all drivers share: the control that switches its automatic, and the one that takes the value.
struct SharedName {
  const char* name;
  std::vector<std::uint32_t> automatic, manual;
  double units = 1;  // of the driver in one of ours
};

const std::vector<SharedName>& sharedNames() {
  static const std::vector<SharedName> names{
      {"exposure", {V4L2_CID_EXPOSURE_AUTO}, {V4L2_CID_EXPOSURE_ABSOLUTE}, 10},  // ms, in 100 us
      {"gain", {V4L2_CID_AUTOGAIN}, {V4L2_CID_GAIN, V4L2_CID_ANALOGUE_GAIN}, 1},
      {"white_balance", {V4L2_CID_AUTO_WHITE_BALANCE}, {V4L2_CID_WHITE_BALANCE_TEMPERATURE}, 1},
      {"focus", {V4L2_CID_FOCUS_AUTO}, {V4L2_CID_FOCUS_ABSOLUTE}, 1},
  };
  return names;
}

struct Setter {
  const CaptureDevice& device;
  const Controls& controls;
  const ControlSetting& setting;

  V4l2Problem problem(const std::string& text, bool may_heal = false) const {
    return {device.path + ": " + setting.name + " " + setting.value + ": " + text, may_heal};
  }

  V4l2Problem write(const CameraControl& control, std::int64_t value) const {
    const std::string allowed = "; allowed for " + control.name + ": " + allowedValues(control);
    if (control.read_only) return problem(control.name + " can only be read");
    const bool is_choice = std::any_of(control.choices.begin(), control.choices.end(),
                                       [&](const ControlChoice& choice) { return choice.value == value; });
    if (value < control.least || value > control.largest || (!control.choices.empty() && !is_choice) ||
        (value - control.least) % control.step != 0) {
      return problem("is not possible" + allowed);
    }
    v4l2_control call{};
    call.id = control.id;
    call.value = static_cast<std::int32_t>(value);
    if (const int error = device.device.control(VIDIOC_S_CTRL, &call); error < 0) {
      return problem("the driver refuses it: " + errorText(error) + allowed, mayHeal(error));
    }
    return {};
  }

  // By the driver's own name.
  V4l2Problem setByName(const CameraControl& control) const {
    for (const ControlChoice& choice : control.choices) {
      if (setting.value == choice.name) return write(control, choice.value);
    }
    if (control.type == V4L2_CTRL_TYPE_BOOLEAN && setting.value == "true") return write(control, 1);
    if (control.type == V4L2_CTRL_TYPE_BOOLEAN && setting.value == "false") return write(control, 0);
    const std::optional<double> number = parseNumber(setting.value);
    if (!number || *number != std::round(*number) || std::abs(*number) > INT32_MAX) {
      return problem("is not possible; allowed for " + control.name + ": " + allowedValues(control));
    }
    return write(control, static_cast<std::int64_t>(*number));
  }

  V4l2Problem switchAutomatic(const CameraControl& control, bool on) const {
    if (control.id != V4L2_CID_EXPOSURE_AUTO) return write(control, on ? 1 : 0);
    if (!on) return write(control, V4L2_EXPOSURE_MANUAL);
    // USB cameras have aperture priority, which is their automatic; others plain automatic.
    for (const std::int64_t mode : {V4L2_EXPOSURE_AUTO, V4L2_EXPOSURE_APERTURE_PRIORITY}) {
      for (const ControlChoice& choice : control.choices) {
        if (choice.value == mode) return write(control, mode);
      }
    }
    return problem("this camera has no automatic exposure; allowed for " + control.name + ": " +
                   allowedValues(control));
  }

  V4l2Problem setShared(const SharedName& shared) const {
    const CameraControl* const automatic = findFirst(controls, shared.automatic);
    const CameraControl* const manual = findFirst(controls, shared.manual);
    if (setting.value == "auto") {
      return automatic != nullptr ? switchAutomatic(*automatic, true)
                                  : problem("this camera has no automatic " + setting.name);
    }
    if (manual == nullptr) return problem("this camera has no control of its " + setting.name);
    const std::optional<double> number = parseNumber(setting.value);
    const double value = number ? std::round(*number * shared.units) : NAN;
    if (!(value >= static_cast<double>(manual->least) && value <= static_cast<double>(manual->largest))) {
      return problem("is not possible; allowed: auto, or " + range(*manual, shared.units));
    }
    if (automatic != nullptr) {
      if (V4l2Problem failed = switchAutomatic(*automatic, false); !failed.text.empty()) return failed;
    }
    // To the nearest step.
    const auto whole = static_cast<std::int64_t>(value);
    return write(*manual, whole - (whole - manual->least) % manual->step);
  }

  static std::string range(const CameraControl& control, double units) {
    if (units == 1) return allowedValues(control);
    const auto text = [&](std::int64_t value) {
      std::string number = std::to_string(static_cast<double>(value) / units);
      number.erase(number.find_last_not_of('0') + 1);
      if (number.back() == '.') number.pop_back();
      return number;
    };
    return text(control.least) + " to " + text(control.largest) + " ms";
  }

  V4l2Problem setPowerLineFrequency() const {
    const CameraControl* const control = find(controls, V4L2_CID_POWER_LINE_FREQUENCY);
    if (control == nullptr) return problem("this camera has no control of it");
    const std::vector<ControlSetting> words{{"off", "0"}, {"50", "1"}, {"60", "2"}, {"auto", "3"}};
    for (const ControlSetting& word : words) {
      if (setting.value == word.name) return write(*control, word.value.front() - '0');
    }
    return problem("expected 50, 60, off or auto");
  }
};

}  // namespace

V4l2Problem setControl(const CaptureDevice& device, const Controls& controls, const ControlSetting& setting) {
  const Setter setter{device, controls, setting};
  // Some drivers have a control of the same name as one that all share; ours also takes the word auto.
  for (const SharedName& shared : sharedNames()) {
    if (setting.name == shared.name) return setter.setShared(shared);
  }
  if (setting.name == "power_line_frequency") return setter.setPowerLineFrequency();
  const auto own =
      std::find_if(controls.begin(), controls.end(), [&](const auto& control) { return control.name == setting.name; });
  if (own != controls.end()) return setter.setByName(*own);
  std::string names;
  for (const CameraControl& control : controls) names += (names.empty() ? "" : ", ") + control.name;
  return setter.problem("this camera has no such control; it has " + (names.empty() ? "none" : names));
}

}  // namespace edgeslam
