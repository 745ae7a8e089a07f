// Pictures of a video file. What decodes them (FFmpeg) is in a library of its own, loaded where a video is opened, so
// that a robot needs none of it (folder video/).
#pragma once

#include <cstddef>
#include <memory>
#include <string>

namespace edgeslam {

// Blue, green, red, 8 bits each; rows are `stride` bytes apart. No pixels: the picture cannot be decoded.
struct VideoPicture {
  const unsigned char* pixels = nullptr;
  int width = 0, height = 0;
  std::size_t stride = 0;
};

// For one thread.
class VideoDecoder {
 public:
  virtual ~VideoDecoder() = default;

  // To the next picture, or the first; false at the end. What is damaged is passed over.
  virtual bool advance() = 0;
  // The current picture, as the file has it: a stored rotation is ignored. It stays until advance() or the next call.
  virtual VideoPicture picture() = 0;
  // Presentation time of the current picture, from the video's beginning [ms]; not a number where it has none.
  virtual double positionMilliseconds() const = 0;
  virtual int width() const = 0;               // of the pictures, as the file says [px]; 0 where it does not
  virtual int height() const = 0;              // likewise
  virtual double framesPerSecond() const = 0;  // 0 where the file does not say so
  virtual double frameCount() const = 0;       // as the file tells or its length lets expect; 0 where neither does
};

// Throws InputError that names the file where the video cannot be opened, or the library is not installed.
std::unique_ptr<VideoDecoder> openVideo(const std::string& path);

// What the library gives; null where the file is no video that can be decoded.
extern "C" using OpenVideoFunction = VideoDecoder * (const char* path);
constexpr const char* open_video_name = "edgeslamOpenVideo";

}  // namespace edgeslam
