#include "drivers/libcamera/control_values.h"

#include <libcamera/control_ids.h>
#include <libcamera/geometry.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "files/text_file.h"

namespace edgeslam {
namespace {

using libcamera::ControlId;
using libcamera::ControlInfo;
using libcamera::ControlInfoMap;
using libcamera::ControlValue;

std::optional<double> numberOf(const ControlValue& value) {
  if (value.isArray()) return std::nullopt;
  switch (value.type()) {
    case libcamera::ControlTypeBool:
      return value.get<bool>() ? 1 : 0;
    case libcamera::ControlTypeInteger32:
      return value.get<std::int32_t>();
    case libcamera::ControlTypeInteger64:
      return static_cast<double>(value.get<std::int64_t>());
    case libcamera::ControlTypeFloat:
      return value.get<float>();
    default:
      return std::nullopt;
  }
}

// Empty where the type takes no number.
ControlValue valueOf(libcamera::ControlType type, double number) {
  switch (type) {
    case libcamera::ControlTypeBool:
      return ControlValue(number != 0);
    case libcamera::ControlTypeInteger32:
      return ControlValue(static_cast<std::int32_t>(std::lround(number)));
    case libcamera::ControlTypeInteger64:
      return ControlValue(static_cast<std::int64_t>(std::llround(number)));
    case libcamera::ControlTypeFloat:
      return ControlValue(static_cast<float>(number));
    default:
      return {};
  }
}

struct Setter {
  const ControlInfoMap& offered;
  libcamera::ControlList& list;
  const ControlSetting& setting;

  std::string problem(const std::string& text) const { return setting.name + " " + setting.value + ": " + text; }

  ControlInfoMap::const_iterator find(const std::string& name) const {
    auto found = offered.begin();
    while (found != offered.end() && found->first->name() != name) ++found;
    return found;
  }
  bool has(const std::string& name) const { return find(name) != offered.end(); }

  std::string set(const std::string& name, double number) const {
    const auto found = find(name);
    if (found == offered.end()) return problem("this camera has no control " + name);
    const ControlInfo& info = found->second;
    const std::optional<double> least = numberOf(info.min()), largest = numberOf(info.max());
    const ControlValue value = valueOf(found->first->type(), number);
    if (value.isNone()) return problem(name + " takes no number");
    if (std::abs(number) > 2e9 || (least && number < *least) || (largest && number > *largest)) {
      return problem("is not possible; allowed for " + name + ": " + info.toString());
    }
    list.set(found->first->id(), value);
    return "";
  }

  // From 0.5 on, exposure and gain have automatics of their own.
  std::string switchAutomatic(bool on) const {
    const std::string name = setting.name == "exposure" ? "ExposureTimeMode" : "AnalogueGainMode";
    if (has(name)) return set(name, on ? 0 : 1);
    if (!on && !has("AeEnable")) return "";
    return set("AeEnable", on ? 1 : 0);
  }

  std::string setValue(const std::string& name, double units) const {
    const std::optional<double> number = parseNumber(setting.value);
    return number ? set(name, *number * units) : problem("is neither auto nor a number");
  }

  std::string setByMeaning() const {
    const bool automatic = setting.value == "auto";
    if (setting.name == "exposure" || setting.name == "gain") {
      if (std::string failed = switchAutomatic(automatic); automatic || !failed.empty()) return failed;
      return setting.name == "exposure" ? setValue("ExposureTime", 1000) : setValue("AnalogueGain", 1);  // in us
    }
    if (setting.name == "white_balance") {
      if (std::string failed = set("AwbEnable", automatic ? 1 : 0); automatic || !failed.empty()) return failed;
      return setValue("ColourTemperature", 1);
    }
    if (setting.name == "focus") {
      constexpr double by_hand = 0, continuous = 2;
      if (std::string failed = set("AfMode", automatic ? continuous : by_hand); automatic || !failed.empty()) {
        return failed;
      }
      return setValue("LensPosition", 1);
    }
    return setPowerLineFrequency();
  }

  std::string setPowerLineFrequency() const {
    constexpr double off = 0, by_hand = 1, automatic = 2;
    if (setting.value == "off") return set("AeFlickerMode", off);
    if (setting.value == "auto") return set("AeFlickerMode", automatic);
    const std::optional<double> frequency = parseNumber(setting.value);
    if (!frequency || (*frequency != 50 && *frequency != 60)) return problem("expected 50, 60, off or auto");
    const std::string failed = set("AeFlickerMode", by_hand);
    return failed.empty() ? set("AeFlickerPeriod", 1e6 / (2 * *frequency)) : failed;  // lights flicker twice a period
  }

  std::string setByName() const {
    if (setting.value == "true" || setting.value == "false") return set(setting.name, setting.value == "true" ? 1 : 0);
    const std::optional<double> number = parseNumber(setting.value);
    if (!has(setting.name)) {
      std::string names;
      for (const auto& [id, info] : offered) names += (names.empty() ? "" : ", ") + id->name();
      return problem("this camera has no such control; it has " + (names.empty() ? "none" : names));
    }
    return number ? set(setting.name, *number) : problem("is not a number");
  }
};

bool isShared(const std::string& name) {
  return name == "exposure" || name == "gain" || name == "white_balance" || name == "focus" ||
         name == "power_line_frequency";
}

}  // namespace

std::string addControls(const CameraOptions& options, const ControlInfoMap& offered, libcamera::ControlList& list) {
  for (const ControlSetting& setting : options.controls) {
    const Setter setter{offered, list, setting};
    const std::string wrong = isShared(setting.name) ? setter.setByMeaning() : setter.setByName();
    if (!wrong.empty()) return wrong;
  }
  const auto has = [&](const ControlId& id) { return offered.find(id.id()) != offered.end(); };
  if (options.frame_rate > 0) {
    if (!has(libcamera::controls::FrameDurationLimits)) {
      return "frame_rate: this camera has no choice of it (no control FrameDurationLimits)";
    }
    const auto duration_us = static_cast<std::int64_t>(std::llround(1e6 / options.frame_rate));
    const ControlInfo& info = offered.at(libcamera::controls::FrameDurationLimits.id());
    const std::optional<double> least = numberOf(info.min()), largest = numberOf(info.max());
    if ((least && static_cast<double>(duration_us) < *least) ||
        (largest && static_cast<double>(duration_us) > *largest)) {
      return "frame_rate " + std::to_string(options.frame_rate) + ": is not possible; allowed are frames of " +
             info.toString() + " us";
    }
    const std::array<std::int64_t, 2> limits{duration_us, duration_us};
    list.set(libcamera::controls::FrameDurationLimits, libcamera::Span<const std::int64_t, 2>(limits));
  }
  if (!options.region.empty()) {
    if (!has(libcamera::controls::ScalerCrop)) return "region: this camera has no choice of it (no control ScalerCrop)";
    const cv::Rect& r = options.region;
    list.set(libcamera::controls::ScalerCrop,
             libcamera::Rectangle(r.x, r.y, static_cast<unsigned int>(r.width), static_cast<unsigned int>(r.height)));
  }
  // There is no limit to set; the short mode prefers gain to exposure time.
  if (options.longest_exposure_ms > 0 && has(libcamera::controls::AeExposureMode)) {
    list.set(libcamera::controls::AeExposureMode, libcamera::controls::ExposureShort);
  }
  return "";
}

}  // namespace edgeslam
