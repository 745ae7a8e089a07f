#include "service/readout_check.h"

#include <cmath>

#include "files/format_text.h"

namespace edgeslam {
namespace {

constexpr double most_difference = 0.2;  // of the driver's

}  // namespace

std::string readoutLine(double used_s, bool is_configured, double driver_s) {
  if (!(driver_s > 0)) return "";
  if (used_s == 0) {
    if (is_configured) return "";
    return formatted(
        "by its driver, the camera reads its rows over %.1f ms: for a rolling shutter put camera.readout: %.4f into "
        "the "
        "configuration, for a global one camera.readout: 0",
        1e3 * driver_s, driver_s);
  }
  // The driver does not know which row is read first.
  if (std::abs(std::abs(used_s) - driver_s) <= most_difference * driver_s) return "";
  return formatted(
      "the readout is %.1f ms by the calibration or camera.readout, and %.1f ms by the camera's driver: is it that of "
      "this mode of the camera?",
      1e3 * used_s, 1e3 * driver_s);
}

}  // namespace edgeslam
