#include "mapping/links_anew.h"

#include <algorithm>

#include "inertia/inertial_history.h"

namespace edgeslam {

void takeLinksAnew(const InertialUnit& unit, const std::vector<InertialSample>& samples, Map& map) {
  const auto is_old = [&](const Keyframe& keyframe) {
    return keyframe.inertia.from >= 0 && keyframe.inertia.offset_ns != unit.offset_ns;
  };
  if (samples.empty() || std::none_of(map.keyframes.begin(), map.keyframes.end(), is_old)) return;
  InertialHistory history(unit, samples.size());
  for (const InertialSample& sample : samples) history.add(sample);
  for (Keyframe& keyframe : map.keyframes) {
    const Keyframe* before = is_old(keyframe) ? map.keyframes.find(keyframe.inertia.from) : nullptr;
    if (!before || keyframe.time_ns + unit.offset_ns > samples.back().time_ns) continue;
    InertialLink& link = keyframe.inertia;
    const auto motion = history.between(before->time_ns, keyframe.time_ns, link.motion.bias);
    link = motion ? InertialLink{link.from, *motion, unit.offset_ns} : InertialLink{};
  }
}

}  // namespace edgeslam
