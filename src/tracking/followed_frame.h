// A frame as tracking follows it: its images and edges, the tracks in it and, once it is located, its pose.
#pragma once

#include <memory>
#include <vector>

#include "adjustment/pose_adjustment.h"
#include "edges/edge_detection.h"
#include "map/keyframe.h"
#include "tracking/measured_noise.h"
#include "tracking/track.h"

namespace edgeslam {

struct FollowedFrame {
  std::shared_ptr<const FrameImages> images;
  std::shared_ptr<EdgeMap> edges;
  std::vector<Track> tracks;             // ascending ids
  std::vector<SeenEdge> straight_edges;  // of a frame that mapping gets to see
  Pose world_T_camera;
  Twist twist = Twist::Zero();             // of the camera as its rows were read; 0 where they are read at once
  Matrix6d covariance = Matrix6d::Zero();  // of the right-hand update [translation; rotation], in the map as it is
  PosePrior known;                         // of its pose before anything was measured in it
  // From the pose to where what was seen has its rotation without what was known: applied on the right; not finite
  // where nothing has.
  Eigen::Vector3d seen_turn = Eigen::Vector3d::Zero();
  int inlier_count = 0;           // map points that agree with the pose
  double outlier_share = 0;       // of the map points in view
  double scene_depth = 1;         // median distance of the map points that the last frame saw [map units]
  bool position_is_held = false;  // the map does not tell it (orientation_only.h)
  bool is_by_wheels = false;      // its pose is by the wheels alone
  OdometryPlace wheels;           // where the wheels say that it is
  NoiseEvidence noise;            // what the map points in view say, be the pose believed or not

  // False before the first frame, and after forget().
  bool isThere() const { return images != nullptr; }
  // Its memory stays, for another frame.
  void forget() { images.reset(); }
};

}  // namespace edgeslam
