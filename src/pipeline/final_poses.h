// The final poses of frames (design, section 5: final poses). A frame is located in the map and with the camera as they
// are known by then, and carried by its keyframe since. When the run ends it is located once more, from what was
// measured in it, in the map as it came to be and with the camera as it was found.
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

// All that have a final pose and are no keyframes. `seen`: by them.
void locateFramesAnew(const Camera& camera, const Map& map, const PoseOptions& options, SeenRecord& seen,
                      std::deque<FrameRecord>& frames);

}  // namespace edgeslam
