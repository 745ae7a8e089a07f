// Exposure time and gain set from the frames' brightness, within a limit on the time (exposure_regulation.h), where a
// driver has them as controls.
#pragma once

#include <optional>
#include <vector>

#include "drivers/frame_capture/exposure_regulation.h"
#include "drivers/v4l2/camera_controls.h"

namespace edgeslam {

class LimitedExposure {
 public:
  // Takes exposure and gain from the driver's automatics. Nothing where the driver has no exposure time to set, or
  // refuses.
  static std::optional<LimitedExposure> take(const CaptureDevice& device, const std::vector<CameraControl>& controls,
                                             double longest_ms);

  // Call it with each frame; every few, as a setting is felt only some frames later, it sets the controls.
  void see(const CaptureDevice& device, const cv::Mat& grey);

  // Of the frames to come [ns].
  std::int64_t exposure_ns() const;

 private:
  LimitedExposure() = default;

  ExposureRange range_;
  ExposureSetting setting_;
  std::uint32_t gain_id_ = 0;  // 0: there is none
  int frames_ = 0;
};

}  // namespace edgeslam
