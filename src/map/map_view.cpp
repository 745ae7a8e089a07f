#include "map/map_view.h"

namespace edgeslam {

MapView flatView(const TrackedFrame& first) {
  MapView view;
  view.origin_frame = first.frame_index;
  view.waiting_for = "motion of the camera";
  view.keyframe_poses.emplace_back();
  for (const PointObservation& observation : first.observations) {
    view.points.push_back({observation.point, 0, observation.bearing, 1.0, flat_start_sigma});
  }
  return view;
}

}  // namespace edgeslam
