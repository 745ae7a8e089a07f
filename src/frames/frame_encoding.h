// How a recorded frame is kept.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

namespace edgeslam {

// How much work is put into it: `packed` halves a frame, `plain` takes a fiftieth of the time.
enum class FrameCode { packed, plain };

// `grey` (CV_8U) as an image file, lossless. Packed it is a PNG, of PNG's ways the one that takes the least time: each
// pixel's difference to its left neighbour, Huffman-coded. 640 x 480 pixels take 2.1 ms of an EPYC core and 120 to
// 170 KB; zlib's level 1 takes 5.7 ms and gives larger files. Plain it is a PGM: 0.05 ms, but 307 KB, which are over
// 9 MB/s at 30 frames/s. False where there is no memory for it.
bool encodeFrame(const cv::Mat& grey, FrameCode code, std::vector<unsigned char>& file);

// ".png" or ".pgm"
const char* fileEnding(FrameCode code);

}  // namespace edgeslam
