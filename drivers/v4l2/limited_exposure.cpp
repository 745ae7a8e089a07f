#include "drivers/v4l2/limited_exposure.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <cmath>

namespace edgeslam {
namespace {

constexpr std::int64_t unit_ns = 100'000;  // of V4L2_CID_EXPOSURE_ABSOLUTE
constexpr int frames_between = 4;

const CameraControl* writableControl(const std::vector<CameraControl>& controls, std::uint32_t id) {
  const auto found = std::find_if(controls.begin(), controls.end(),
                                  [&](const CameraControl& control) { return control.id == id && !control.read_only; });
  return found == controls.end() ? nullptr : &*found;
}

// 0 or a negative errno.
int write(const CaptureDevice& device, std::uint32_t id, std::int64_t value) {
  v4l2_control control{id, static_cast<std::int32_t>(value)};
  return device.device.control(VIDIOC_S_CTRL, &control);
}

}  // namespace

std::optional<LimitedExposure> LimitedExposure::take(const CaptureDevice& device,
                                                     const std::vector<CameraControl>& controls, double longest_ms) {
  const CameraControl* const exposure = writableControl(controls, V4L2_CID_EXPOSURE_ABSOLUTE);
  if (exposure == nullptr) return std::nullopt;
  if (writableControl(controls, V4L2_CID_EXPOSURE_AUTO) != nullptr &&
      write(device, V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL) < 0) {
    return std::nullopt;
  }
  LimitedExposure limited;
  limited.range_.least_exposure = std::max<std::int64_t>(exposure->least, 1);
  const auto longest = static_cast<std::int64_t>(longest_ms * 1e6 / static_cast<double>(unit_ns));
  limited.range_.longest_exposure =
      std::clamp(longest, limited.range_.least_exposure, std::max(exposure->largest, limited.range_.least_exposure));
  limited.setting_.exposure =
      std::clamp(exposure->value, limited.range_.least_exposure, limited.range_.longest_exposure);
  if (write(device, V4L2_CID_EXPOSURE_ABSOLUTE, limited.setting_.exposure) < 0) return std::nullopt;

  for (const std::uint32_t id : {V4L2_CID_GAIN, V4L2_CID_ANALOGUE_GAIN}) {
    const CameraControl* const gain = writableControl(controls, id);
    if (gain == nullptr) continue;
    if (writableControl(controls, V4L2_CID_AUTOGAIN) != nullptr) write(device, V4L2_CID_AUTOGAIN, 0);
    limited.gain_id_ = id;
    limited.range_.least_gain = gain->least;
    limited.range_.largest_gain = gain->largest;
    limited.setting_.gain = std::clamp(gain->value, gain->least, gain->largest);
    break;
  }
  return limited;
}

void LimitedExposure::see(const CaptureDevice& device, const cv::Mat& grey) {
  if (++frames_ % frames_between != 0) return;
  const ExposureSetting next = nextExposure(setting_, range_, frameBrightness(grey));
  // What the driver refuses is tried again later; a camera that is gone shows elsewhere.
  if (next.exposure != setting_.exposure && write(device, V4L2_CID_EXPOSURE_ABSOLUTE, next.exposure) == 0) {
    setting_.exposure = next.exposure;
  }
  if (next.gain != setting_.gain && write(device, gain_id_, next.gain) == 0) setting_.gain = next.gain;
}

std::int64_t LimitedExposure::exposure_ns() const { return setting_.exposure * unit_ns; }

}  // namespace edgeslam
