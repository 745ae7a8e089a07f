#include "image_formats/jpeg.h"

#include <turbojpeg.h>

#include <cstdint>
#include <memory>
#include <new>

#include "image_formats/image_header.h"

namespace edgeslam {
namespace {

constexpr int most_scans = 64;  // encoders make some ten of a progressive image

const unsigned char* pointer(std::string_view bytes) { return reinterpret_cast<const unsigned char*>(bytes.data()); }

using Handle = std::unique_ptr<void, decltype(&tjDestroy)>;

Handle opened(tjhandle handle) {
  if (handle == nullptr) throw std::bad_alloc();
  return {handle, tjDestroy};
}

struct Segments {
  bool is_whole = false;
  int scans = 0;
};

// Walks the segments of a JPEG file to its end-of-image marker (ISO 10918-1, annex B). An embedded thumbnail has such a
// marker too, so the last bytes alone don't tell.
Segments segmentsOf(std::string_view bytes) {
  Segments segments;
  const auto byteAt = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  std::size_t at = 2;
  while (at + 1 < bytes.size()) {
    if (byteAt(at) != 0xFF) {  // entropy-coded data
      ++at;
      continue;
    }
    const unsigned char marker = byteAt(at + 1);
    if (marker == 0xD9) {
      segments.is_whole = true;
      return segments;
    }
    if (marker == 0xFF) {
      ++at;
      continue;
    }
    at += 2;
    if (marker == 0xDA) ++segments.scans;
    const bool stands_alone = marker == 0x00 || marker == 0x01 || (marker >= 0xD0 && marker <= 0xD8);
    if (stands_alone) continue;
    if (at + 1 >= bytes.size()) return segments;
    at += static_cast<std::size_t>(byteAt(at)) * 256 + byteAt(at + 1);
  }
  return segments;
}

}  // namespace

bool jpegIsWhole(std::string_view bytes) { return segmentsOf(bytes).is_whole; }

cv::Mat decodeJpeg(std::string_view bytes) {
  if (segmentsOf(bytes).scans > most_scans) return {};
  const Handle decoder = opened(tjInitDecompress());
  int width = 0, height = 0, subsampling = 0, colours = 0;
  const int header =
      tjDecompressHeader3(decoder.get(), pointer(bytes), bytes.size(), &width, &height, &subsampling, &colours);
  if (header != 0 || width < 1 || height < 1) return {};
  if (std::int64_t{width} * height > most_pixels) return {};
  cv::Mat grey(height, width, CV_8U);
  const int failed = tjDecompress2(decoder.get(), pointer(bytes), bytes.size(), grey.ptr(), width,
                                   static_cast<int>(grey.step), height, TJPF_GRAY, TJFLAG_ACCURATEDCT);
  if (failed != 0 && tjGetErrorCode(decoder.get()) != TJERR_WARNING) return {};
  return grey;
}

std::vector<unsigned char> encodeJpeg(const cv::Mat& image, int quality) {
  CV_Assert(!image.empty() && (image.type() == CV_8UC1 || image.type() == CV_8UC3));
  const bool is_grey = image.channels() == 1;
  const int subsampling = is_grey ? TJSAMP_GRAY : TJSAMP_420;
  const Handle encoder = opened(tjInitCompress());
  std::vector<unsigned char> jpeg(tjBufSize(image.cols, image.rows, subsampling));
  unsigned char* target = jpeg.data();
  unsigned long size = jpeg.size();
  const int failed = tjCompress2(encoder.get(), image.ptr(), image.cols, static_cast<int>(image.step), image.rows,
                                 is_grey ? TJPF_GRAY : TJPF_BGR, &target, &size, subsampling, quality,
                                 TJFLAG_ACCURATEDCT | TJFLAG_NOREALLOC);
  if (failed != 0) throw std::bad_alloc();
  jpeg.resize(size);
  return jpeg;
}

}  // namespace edgeslam
