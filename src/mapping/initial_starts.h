// P14: the starts that an initial structure is adjusted from. One goes on from what tracking followed against a map of
// points at one depth; its rivals, from quite different places, are there to be held against it.
#pragma once

#include <optional>
#include <vector>

#include "mapping/initial_structure.h"

namespace edgeslam {

// "flat start": the provisional inverse depths, one a point of the first frame, and the frames' provisional poses.
InitialStart followedStart(const InitialFrames& frames, const std::vector<double>& provisional_inverse_depths,
                           const InitialisationOptions& options);

// A start of which the poses are known: with the inverse depths that its frames tell, their median 1 and the poses
// scaled with them. Nothing where too few points have one.
std::optional<InitialStart> withTriangulatedDepths(const Camera& camera, const InitialFrames& frames,
                                                   InitialStart start);

// "five-point": the pose of the current frame by the five-point algorithm, depths by triangulation, the poses of the
// frames between by their points. Nothing where corner-like points are few, or where it finds no pose or too few
// depths.
std::optional<InitialStart> fivePointStart(const Camera& camera, const InitialFrames& frames,
                                           const InitialisationOptions& options);

// Cameras that moved steadily forward, rightward, leftward, downward and upward ("forward start", ...), in that order,
// turning as the points' bearings say; those left out that find too few depths.
std::vector<InitialStart> steadyMotionStarts(const Camera& camera, const InitialFrames& frames,
                                             const InitialisationOptions& options);

}  // namespace edgeslam
