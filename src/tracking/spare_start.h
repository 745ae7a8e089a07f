// A second first frame for a start (section 3.3): where the points of the first one fade, a younger frame is kept
// beside it, with fresh points. Should the start have to be given up, it goes on from that frame, and need not wait for
// the camera to move as far again.
#pragma once

#include "tracking/followed_frame.h"

namespace edgeslam {

class SpareStart {
 public:
  // Takes memory for frames with so many tracks.
  explicit SpareStart(std::size_t most_tracks) { first_.observations.reserve(most_tracks); }

  // `frame`: its tracks from `first_new_point` on were chosen in it. Its pose is against the start that it stands
  // beside.
  void begin(const Camera& camera, const FollowedFrame& frame, KeyframeId keyframe, PointId first_new_point);
  void forget();
  bool isThere() const { return is_there_; }

  // The frame as mapping gets to see it.
  const TrackedFrame& first() const { return first_; }
  // Of these tracks, those of the start that it stands beside.
  std::size_t countOlder(const std::vector<Track>& tracks) const;
  // A later frame with a pose against that start becomes one of this one.
  void adopt(FollowedFrame& frame) const;

 private:
  bool is_there_ = false;
  TrackedFrame first_;
  PointId first_new_point_ = 0;
};

}  // namespace edgeslam
