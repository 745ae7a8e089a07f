// A place as one keyframe shows it: the map points that it and its neighbours see, in that keyframe's frame (P26, P27:
// "points visible to the keyframe and its neighbours").
#pragma once

#include <memory>
#include <vector>

#include "geometry/camera.h"
#include "geometry/similarity.h"
#include "map/map.h"

namespace edgeslam {

constexpr double image_border = 8;  // points nearer to it are not looked at [px]

struct PlacePoint {
  PointId id = 0;
  Eigen::Vector3d position;    // keyframe's camera frame [map units]
  double depth_deviation = 0;  // standard deviation of the distance, as a share of it
  Measurement measurement;     // in the keyframe: as measured there, or where the point projects
  bool corner = false;
  bool observed = false;  // in the keyframe itself
};

struct PlaceView {
  KeyframeId keyframe = -1;
  std::shared_ptr<const FrameImages> images;
  std::vector<PlacePoint> points;  // those observed first; of the others none within 3 px of another
};

// The points that `keyframe` observes, then those of the `neighbours` keyframes that share most points with it, where
// they project into its image.
PlaceView placeView(const Camera& camera, const Map& map, KeyframeId keyframe, int neighbours);

// The keyframes that share most points with `keyframe`, best first, at most `count`, without itself.
std::vector<KeyframeId> covisibleWith(const Map& map, KeyframeId keyframe, int count);

// Measurement of a point in another camera, predicted: `camera_T_view` takes the camera frame in which `point` and its
// measurement are given to the other one, up to scale. The deviations stay as they were. False where the point or its
// edge is not seen there.
bool predictMeasurement(const Camera& camera, const Pose& camera_T_view, const Eigen::Vector3d& point,
                        const Measurement& measurement, Measurement& predicted);

// The rigid motion that sees what a similarity sees: all lengths in units of the side that it comes from.
inline Pose upToScale(const Similarity& similarity) {
  return {similarity.rotation, similarity.translation / similarity.scale};
}

}  // namespace edgeslam
