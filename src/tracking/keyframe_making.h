// Keyframes (section 3.2, P8 to P12): when a frame becomes one, and the points that are chosen in it.
#pragma once

#include <vector>

#include "edges/point_choice.h"
#include "geometry/camera.h"
#include "map/map_view.h"
#include "tracking/followed_frame.h"
#include "tracking/keyframe_selection.h"

namespace edgeslam {

class KeyframeMaking {
 public:
  // `spread`: of the points that are tracked.
  KeyframeMaking(const Camera& camera, const KeyframeOptions& options, const PointSpread& spread);

  // A map is there already: keyframes and points get the numbers after its own.
  void goOnFrom(KeyframeId next_keyframe, PointId next_point);

  // Another world: the numbers that were given go on being those of the ones before.
  void beginWorld() { first_of_world_ = next_keyframe_; }
  // For frames to come: it was found to be another one.
  void setCamera(const Camera& camera) { camera_ = camera; }

  // The frame's own points, as those of a world's first keyframe; what was tracked in it is forgotten.
  void choosePointsOfFirst(FollowedFrame& frame, const PointAccuracy& accuracy);
  // Points beside those that are tracked in a frame that is none of a keyframe's; gives the first one's number.
  PointId choosePointsOfSpare(FollowedFrame& frame, const PointAccuracy& accuracy);
  KeyframeId firstOfWorld() const { return first_of_world_; }

  // P8 to P12, for a frame that is located in `view`.
  KeyframeDecision judge(const MapView& view, const FollowedFrame& frame) const;
  // Tracks begin anew from this frame, and others are chosen beside them. Gives the keyframe's number.
  KeyframeId make(FollowedFrame& frame, const PointAccuracy& accuracy);
  // The number that a lost frame gets if it is recovered as a keyframe.
  KeyframeId numberOfLost() { return next_keyframe_++; }
  // Mapping has keyframes up to this one.
  void seen(KeyframeId latest);

  // After each frame that was located.
  void follow(const FollowedFrame& frame);
  // The next frame may become one, with fresh points; `last`: the one that was located last.
  void askForOne(const FollowedFrame& last);
  void forgetAverage() { average_tracks_ = 0; }

  // Since the last keyframe.
  int frames() const { return frames_; }

 private:
  void choosePointsIn(FollowedFrame& frame, KeyframeId keyframe, const PointAccuracy& accuracy);

  Camera camera_;
  KeyframeOptions options_;
  PointSpread spread_;
  PointChoiceWorkspace workspace_;
  std::vector<Eigen::Vector2f> occupied_;
  std::vector<ChosenPoint> chosen_;
  PointId next_point_ = 0;
  KeyframeId next_keyframe_ = 0;
  KeyframeId first_of_world_ = 0;
  std::int64_t time_ns_ = 0;      // of the last keyframe
  std::int64_t earliest_ns_ = 0;  // of the next one
  int frames_ = 0;                // since then
  int most_mapped_ = 0;           // likewise
  double average_tracks_ = 0;     // running average over the frames
};

}  // namespace edgeslam
