// Frames of a camera as a folder in TUM layout, written while they come: rgb/SECONDS.png, rgb.txt that names them, and
// camera.yaml where the calibration is known. What is on disk can be read at every moment, however the writing ends:
// the list names only what the disk has confirmed, which it is asked for once a second of frames.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "geometry/camera.h"

namespace edgeslam {

class FrameFolderWriter {
 public:
  // Makes the folder, or takes an empty one. `source` goes into the list's first line. Throws InputError where that
  // fails, or where the disk has less than `free_bytes_kept` free.
  FrameFolderWriter(std::string folder, const std::optional<Camera>& camera, const std::string& source,
                    std::int64_t free_bytes_kept);
  // Closes the list, as close() does.
  ~FrameFolderWriter();
  FrameFolderWriter(const FrameFolderWriter&) = delete;
  FrameFolderWriter& operator=(const FrameFolderWriter&) = delete;

  // `grey`: CV_8U; time stamps grow. Returns what went wrong (full disk, a limit reached), after which nothing more is
  // written, or an empty text. A frame that could not be written whole is not there.
  std::string write(std::int64_t time_ns, const cv::Mat& grey);
  // Waits until the disk holds all frames and the list of them. What went wrong, or an empty text.
  std::string close();

  std::int64_t frames() const { return frames_; }
  std::int64_t bytes() const { return bytes_; }  // of the images

 private:
  std::string fail(const std::string& problem);
  std::string sync();

  std::string folder_;
  std::int64_t free_bytes_kept_;
  int list_ = -1;  // rgb.txt
  std::int64_t frames_ = 0, bytes_ = 0;
  std::int64_t last_ns_ = -1, synced_ns_ = -1;
  std::string waiting_lines_;  // of frames that the disk has not confirmed
  std::string problem_;
  std::vector<unsigned char> png_;
};

}  // namespace edgeslam
