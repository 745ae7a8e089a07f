// The final poses of frames (design, section 5: final poses). A frame is located in the map and with the camera as they
// are known by then, and carried by its keyframe since. When the run ends it is located once more, from what was
// measured in it, in the map as it came to be and with the camera as it was found; and all of them together, since a
// camera moves smoothly from frame to frame.
#pragma once

#include <deque>
#include <optional>

#include "adjustment/pose_adjustment.h"
#include "map/map.h"
#include "pipeline/run_result.h"
#include "pipeline/seen_record.h"

namespace edgeslam {

// Near where it is carried to: what the points do not tell stays as it is. Nothing where too few of the points are
// still in the map, or agree. `world`: that the frame is in.
std::optional<Pose> locateAnew(const Camera& camera, const Map& map, int world, const SeenPoints& seen,
                               const MovingCamera& carried, const PoseOptions& options);

// All that have a final pose and are no keyframes, each by itself. `seen`: by them.
void locateFramesAnew(const Camera& camera, const Map& map, const PoseOptions& options, SeenRecord& seen,
                      std::deque<FrameRecord>& frames);

// Then together, between keyframes, whose poses stay. How much the speed changes from frame to frame is what it did
// from keyframe to keyframe around. Runs of frames with fewer than five keyframes stay as they are, and so do frames
// that show next to nothing of the map: inertia or wheels told their poses.
void smoothFrames(const Camera& camera, const Map& map, const PoseOptions& options, SeenRecord& seen,
                  std::deque<FrameRecord>& frames);

}  // namespace edgeslam
