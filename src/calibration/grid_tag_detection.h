// The tags of an AprilGrid. The small squares between them touch their corners, and so join their outlines, which
// markers are usually found by: here black is eaten away until they come apart, and grown back to read the tags.
#pragma once

#include <vector>

#include "calibration/board.h"
#include "calibration/marker_detection.h"

namespace edgeslam {

// Tags of the board in a grey image (CV_8U), each number once, with corners to a pixel or two.
std::vector<DetectedMarker> detectGridTags(const cv::Mat& grey, const Board& board);

}  // namespace edgeslam
