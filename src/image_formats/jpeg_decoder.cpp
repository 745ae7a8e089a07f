#include "image_formats/jpeg_decoder.h"

#include <turbojpeg.h>

#include <cstring>
#include <utility>

namespace edgeslam {
namespace {

// Some cameras pad their frames before the end marker, which harms nothing. TurboJPEG tells it only by its text.
bool isPaddingAtTheEnd(const char* warning) {
  return std::strstr(warning, "extraneous bytes before marker 0xd9") != nullptr;
}

}  // namespace

JpegDecoder::JpegDecoder() : decoder_(tjInitDecompress()) {}

JpegDecoder::~JpegDecoder() {
  if (decoder_ != nullptr) tjDestroy(decoder_);
}

std::string JpegDecoder::decode(const std::uint8_t* data, std::size_t size, cv::Mat& grey) {
  if (decoder_ == nullptr) return "no memory for the JPEG decoder";
  if (size < 4 || data[0] != 0xFF || data[1] != 0xD8) return "no JPEG image: it does not begin with FF D8";
  int width = 0, height = 0, subsampling = 0, colours = 0;
  if (tjDecompressHeader3(decoder_, data, size, &width, &height, &subsampling, &colours) != 0) {
    std::string problem = std::string("a broken JPEG header: ") + tjGetErrorStr2(decoder_);
    // It would take the next frame for the rest of this header.
    tjDestroy(std::exchange(decoder_, tjInitDecompress()));
    return problem;
  }
  if (width != grey.cols || height != grey.rows) {
    return "a JPEG image of " + std::to_string(width) + " x " + std::to_string(height) + " pixels, expected " +
           std::to_string(grey.cols) + " x " + std::to_string(grey.rows);
  }
  if (colours != TJCS_YCbCr && colours != TJCS_GRAY) return "a JPEG image in other colours than YCbCr or grey";
  // With grey as the output, colour is entropy-decoded and left at that.
  const auto decompress = [&](int flags) {
    return tjDecompress2(decoder_, data, size, grey.data, width, static_cast<int>(grey.step), height, TJPF_GRAY,
                         flags | TJFLAG_LIMITSCANS) == 0;
  };
  if (decompress(TJFLAG_STOPONWARNING)) return "";
  // The decoder stopped at its first warning; where that is the harmless one, all rows are wanted.
  if (tjGetErrorCode(decoder_) == TJERR_WARNING && isPaddingAtTheEnd(tjGetErrorStr2(decoder_))) {
    decompress(0);
    return "";
  }
  return std::string("a broken JPEG image: ") + tjGetErrorStr2(decoder_);
}

}  // namespace edgeslam
