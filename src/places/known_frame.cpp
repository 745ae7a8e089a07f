#include "places/known_frame.h"

#include <cmath>

#include "files/format_text.h"
#include "geometry/angles.h"

namespace edgeslam {
namespace {

// What the one unit is of the other by what is known of both.
std::optional<double> knownScale(const KnownFrame& from, const KnownFrame& to) {
  if (!from.metres_a_unit || !to.metres_a_unit) return std::nullopt;
  return *from.metres_a_unit / *to.metres_a_unit;
}

}  // namespace

KnownFrame knownFrame(const Map& map, int world) {
  KnownFrame frame;
  const auto wheels = map.wheels.find(world);
  if (wheels != map.wheels.end() && wheels->second.is_known) frame.metres_a_unit = wheels->second.metres_a_unit;
  const auto inertia = map.inertia.find(world);
  if (inertia == map.inertia.end() || !inertia->second.is_known) return frame;
  frame.metres_a_unit = inertia->second.metres_a_unit;
  frame.up = -inertia->second.gravity.normalized();
  return frame;
}

std::string contradiction(const KnownFrame& from, const KnownFrame& to, const Similarity& to_S_from,
                          const KnownFrameOptions& options) {
  if (from.up && to.up) {
    const Eigen::Vector3d up = to_S_from.rotation * *from.up;
    const double tilt_deg = degrees(std::atan2(up.cross(*to.up).norm(), up.dot(*to.up)));
    if (tilt_deg > options.largest_tilt_deg) return formatted("would tilt what is upright by %.0f deg", tilt_deg);
  }
  if (const std::optional<double> scale = knownScale(from, to)) {
    const double off = to_S_from.scale / *scale;
    if (std::abs(std::log(off)) > std::log(options.largest_scale))
      return formatted("would make what is known in metres %.2f times as long", off);
  }
  return "";
}

Similarity putRight(const KnownFrame& from, const KnownFrame& to, const Similarity& to_S_from,
                    const Eigen::Vector3d& place) {
  Similarity right = to_S_from;
  if (from.up && to.up) {
    const Eigen::Vector3d up = to_S_from.rotation * *from.up;
    right.rotation = (Eigen::Quaterniond::FromTwoVectors(up, *to.up) * to_S_from.rotation).normalized();
  }
  if (const std::optional<double> scale = knownScale(from, to)) right.scale = *scale;
  right.translation = to_S_from * place - right.scale * (right.rotation * place);
  return right;
}

}  // namespace edgeslam
