// A frame as a motion-JPEG camera sends it: in colour, without Huffman tables, padded before its end.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "image_formats/jpeg.h"
#include "image_formats/jpeg_decoder.h"

namespace edgeslam {

// Without its Huffman tables, which are the usual ones.
inline std::vector<unsigned char> withoutHuffmanTables(const std::vector<unsigned char>& jpeg) {
  std::vector<unsigned char> kept(jpeg.begin(), jpeg.begin() + 2);
  std::size_t at = 2;
  while (jpeg[at + 1] != 0xDA) {
    const std::size_t length = 2 + jpeg[at + 2] * 256U + jpeg[at + 3];
    const auto begin = jpeg.begin() + static_cast<std::ptrdiff_t>(at);
    if (jpeg[at + 1] != 0xC4) kept.insert(kept.end(), begin, begin + static_cast<std::ptrdiff_t>(length));
    at += length;
  }
  kept.insert(kept.end(), jpeg.begin() + static_cast<std::ptrdiff_t>(at), jpeg.end());
  return kept;
}

// `grey`: CV_8U, what it shows in shades of one colour.
inline std::vector<unsigned char> madeJpeg(const cv::Mat& grey) {
  cv::Mat colour;
  cv::merge(std::vector<cv::Mat>{grey, grey / 2, 255 - grey}, colour);
  std::vector<unsigned char> jpeg = withoutHuffmanTables(encodeJpeg(colour, 85));
  jpeg.insert(jpeg.end() - 2, 5, 0);
  return jpeg;
}

// The pixels that a camera gives of it. CV_8U; empty where it is broken.
inline cv::Mat decodedAsLive(const std::vector<unsigned char>& jpeg, cv::Size size) {
  cv::Mat grey(size, CV_8U);
  JpegDecoder decoder;
  return decoder.decode(jpeg.data(), jpeg.size(), grey).empty() ? grey : cv::Mat();
}

}  // namespace edgeslam
