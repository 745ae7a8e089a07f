// A walk past a textured plane, and the map that mapping would make of it if it knew the plane.
#pragma once

#include <map>

#include "map/map_view.h"
#include "unit/tracking/textured_plane.h"

namespace edgeslam {

inline const Camera walking_camera = smallCamera();
constexpr std::int64_t walking_interval_ns = 33'333'333;

inline const TexturedPlane& wall() {
  static const TexturedPlane plane{SmoothTexture(51, 10, 60)};
  return plane;
}

// Where the camera is at frame `i`: past the plane, turning a little.
inline Pose walk(int i) { return {rotationExp({0.002 * i, -0.003 * i, 0.001 * i}), {0.012 * i, 0.005 * i, 0.004 * i}}; }

// Rendered once, as that takes longer than tracking.
inline const cv::Mat& imageAt(int i) {
  static std::map<int, cv::Mat> rendered;
  cv::Mat& image = rendered[i];
  if (image.empty()) image = wall().render(walking_camera, walk(i));
  return image;
}

inline const cv::Mat& elsewhere() {
  static const cv::Mat image = TexturedPlane{SmoothTexture(77, 10, 60)}.render(walking_camera, Pose());
  return image;
}

// What mapping would answer to the first frame, if it knew the plane.
inline MapView knownMap(const TrackedFrame& first) {
  MapView view = flatView(first);
  view.version = 1;
  view.initialised = true;
  view.waiting_for.clear();
  view.keyframes[0].images = first.images;
  for (std::size_t i = 0; i < view.points.size(); ++i) {
    const PointObservation& seen = first.observations[i];
    ViewPoint& point = view.points[i];
    point = viewPoint(view, point.id, 0, wall().seenAt(walking_camera, Pose(), seen.measurement.pixel));
    point.source = 0;
    point.source_measurement = seen.measurement;
    point.corner = seen.corner;
  }
  return view;
}

}  // namespace edgeslam
