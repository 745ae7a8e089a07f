#include "map/map_view.h"

namespace edgeslam {

MapView flatView(const TrackedFrame& first) {
  MapView view;
  view.origin_frame = first.frame_index;
  view.waiting_for = "motion of the camera";
  view.keyframes.push_back(ViewKeyframe());
  for (const PointObservation& observation : first.observations) {
    ViewPoint point;
    point.id = observation.point;
    point.host_bearing = observation.bearing;
    point.inverse_depth = 1.0;
    point.inverse_depth_sigma = flat_start_sigma;
    view.points.push_back(point);
  }
  return view;
}

}  // namespace edgeslam
