#include "map/map_view.h"

namespace edgeslam {

void reserveForTracking(MapView& view) {
  constexpr std::size_t most_new_keyframes = 64, most_points_of_a_start = 1024, longest_text = 128;
  view.keyframes.reserve(view.keyframes.size() + most_new_keyframes);
  view.points.reserve(std::max(view.points.size(), most_points_of_a_start));
  view.waiting_for.reserve(longest_text);
}

MapView flatView(const TrackedFrame& first) {
  MapView view;
  makeFlatView(first, view);
  return view;
}

void makeFlatView(const TrackedFrame& first, MapView& view) {
  view.version = 0;
  view.corrections = 0;
  view.initialised = false;
  view.inertia.reset();
  view.wheels = {};
  view.keyframes.clear();
  view.points.clear();
  view.origin_frame = first.frame_index;
  view.waiting_for = "motion of the camera";
  view.latest_keyframe = first.keyframe;
  view.keyframes.push_back({first.keyframe, Pose(), nullptr});
  for (const PointObservation& observation : first.observations) {
    ViewPoint point;
    point.id = observation.point;
    point.host = first.keyframe;
    point.host_bearing = observation.bearing;
    point.inverse_depth = 1.0;
    point.inverse_depth_sigma = flat_start_sigma;
    view.points.push_back(point);
  }
}

}  // namespace edgeslam
