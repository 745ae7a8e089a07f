// P14: the starts that an initial structure is adjusted from. One goes on from what tracking followed against a map of
// points at one depth; its rivals, from quite different places, are there to be held against it.
#pragma once

#include <vector>

#include "mapping/initial_structure.h"

namespace edgeslam {

// "flat start": the provisional inverse depths, one a point of the first frame, and the frames' provisional poses.
InitialStart followedStart(const InitialFrames& frames, const std::vector<double>& provisional_inverse_depths,
                           const InitialisationOptions& options);

// "five-point", where corner-like points are many, and steady motions forward, rightward, leftward, downward and upward
// ("forward start", ...), in that order; those left out that find no pose or too few depths. Their median inverse depth
// is 1. The same frames give the same starts.
std::vector<InitialStart> rivalStarts(const Camera& camera, const InitialFrames& frames,
                                      const InitialisationOptions& options);

}  // namespace edgeslam
