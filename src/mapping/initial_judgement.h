// P13 and P15: whether the camera moved enough for a start, and whether an adjusted structure is to be believed. Cost
// alone never decides.
#pragma once

#include <string>

#include "mapping/initial_structure.h"
#include "mapping/quality_factor.h"

namespace edgeslam {

// P13: median displacement of the points between the first and the current frame, less what a rotation explains [px]; 0
// where too few are in both.
double displacementLessRotation(const Camera& camera, const InitialFrames& frames);

// What it must be to begin with [px]. Small images that show many corners begin a run's first map with less: in pixels
// their points move less. A map beside others has time, as these are looked for meanwhile.
double leastDisplacement(const Camera& camera, const InitialFrames& frames, const InitialisationOptions& options);

// What speaks for a structure, over the first frame's points that the current frame sees.
struct InitialEvidence {
  int frames = 0;           // since the first
  int followed = 0;         // all of them
  int points = 0;           // those whose depth is known well enough
  double parallax_deg = 0;  // median angle under which these see the two cameras
  QualityFactor quality;    // P15, of these
};
InitialEvidence judgeInitialStructure(const InitialFrames& frames, const InitialStructure& structure,
                                      const InitialisationOptions& options);

// What is still missing, in words; empty where the structure is to be believed.
std::string reasonToWait(const InitialEvidence& evidence, const InitialisationOptions& options);

// "quality 90 of 120 edge pieces, parallax 1.52 deg, 130 points".
std::string inWords(const InitialEvidence& evidence);

}  // namespace edgeslam
