// A point of an edge on its way through the images.
#pragma once

#include <memory>

#include "map/keyframe.h"

namespace edgeslam {

struct Track {
  PointId id = 0;
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();    // in the last frame in which it was found [px]
  Eigen::Vector2f normal = Eigen::Vector2f::UnitX();  // unit, from dark to bright
  bool corner = false;
  float sigma_normal = 0.5f;            // [px]
  float sigma_tangent = unknown_along;  // [px]
  int chain = -1;                       // of the edge on which it was chosen
  int order = 0;                        // place along that chain
  int straight_edge = -1;               // of the latest frame that mapping got to see (tracking/edge_tracks.h)
  KeyframeId keyframe = -1;             // the keyframe whose patch it is compared with
  std::shared_ptr<const FrameImages> keyframe_images;
  Eigen::Vector2f keyframe_pixel = Eigen::Vector2f::Zero();       // its pixel there [px]
  Eigen::Vector2f last_keyframe_pixel = Eigen::Vector2f::Zero();  // its pixel in the latest keyframe [px]
  int outlier_frames = 0;  // frames in a row in which its map point did not fit the pose
};

// Along a straight edge nothing is known, whatever its patch seems to say.
inline float sigmaAlong(const Track& track) {
  return track.straight_edge >= 0 && !track.corner ? unknown_along : track.sigma_tangent;
}

inline Measurement measurementOf(const Track& track) {
  return {track.pixel.cast<double>(), track.normal.cast<double>(), track.sigma_normal, track.sigma_tangent};
}

}  // namespace edgeslam
