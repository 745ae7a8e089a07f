#include "tracking/spare_start.h"

#include <algorithm>
#include <cassert>

#include "tracking/tracked_frame.h"

namespace edgeslam {

void SpareStart::begin(const Camera& camera, const FollowedFrame& frame, KeyframeId keyframe, PointId first_new_point) {
  describe(camera, frame, {FrameKind::spare, keyframe, "first"}, first_);
  first_new_point_ = first_new_point;
  is_there_ = true;
}

void SpareStart::forget() {
  is_there_ = false;
  first_.images.reset();
}

std::size_t SpareStart::countOlder(const std::vector<Track>& tracks) const {
  if (!is_there_) return tracks.size();
  return static_cast<std::size_t>(
      std::count_if(tracks.begin(), tracks.end(), [&](const Track& track) { return track.id < first_new_point_; }));
}

void SpareStart::adopt(FollowedFrame& frame) const {
  std::size_t seen = 0;
  for (Track& track : frame.tracks) {  // all were there in the first frame
    while (first_.observations[seen].point < track.id) ++seen;
    assert(first_.observations[seen].point == track.id);
    track.keyframe = first_.keyframe;
    track.keyframe_images = first_.images;
    track.keyframe_pixel = track.last_keyframe_pixel = first_.observations[seen].measurement.pixel.cast<float>();
  }
  frame.world_T_camera = first_.world_T_camera.inverse() * frame.world_T_camera;
}

}  // namespace edgeslam
