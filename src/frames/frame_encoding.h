// How a recorded frame is kept.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

namespace edgeslam {

// `grey` (CV_8U) as PNG, lossless. Of PNG's ways the one that takes the least time: each pixel's difference to its left
// neighbour (what OpenCV does unless told a level), Huffman-coded. 640 x 480 pixels take 2.1 ms of an EPYC core and 120
// to 170 KB; zlib's level 1 takes 5.7 ms and gives larger files. A PGM takes 0.05 ms but 307 KB: over 9 MB/s at
// 30 frames/s, which wears out an SD card and halves the time that fits into the budget.
// False where there is no memory for it.
bool encodeFrame(const cv::Mat& grey, std::vector<unsigned char>& png);

}  // namespace edgeslam
