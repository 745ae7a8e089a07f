// How well a track is known across and along its edge, from the structure tensor around it in the current image.
#pragma once

#include "edges/point_accuracy.h"
#include "tracking/track.h"

namespace edgeslam {

// Renews the track's normal, kind and standard deviations.
void updateAccuracy(const cv::Mat& grey, const PointAccuracy& accuracy, Track& track);

}  // namespace edgeslam
