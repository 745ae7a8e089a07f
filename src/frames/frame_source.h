// Frames from a folder or a video, one at a time: TUM RGB-D and ICL-NUIM folders (rgb.txt), EuRoC folders (mav0/cam0 or
// cam0), folders with a video and times.txt, plain folders of images with time stamps, video files.
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>

#include "edgeslam/input_error.h"
#include "frames/inertial_file.h"
#include "geometry/camera.h"

namespace edgeslam {

struct Recording;  // recording/recording_source.h

struct Frame {
  std::int64_t index = 0;  // in the source, counted from 0, unreadable ones and those a live run dropped included
  std::int64_t time_ns = 0;
  cv::Mat grey;         // CV_8U, the camera's size; empty where the frame could not be read
  std::string problem;  // why it could not be read; empty otherwise
};

class FrameSource {
 public:
  virtual ~FrameSource() = default;
  // The next frame in order, or nothing at the end. A single unreadable frame is returned with `problem` set.
  virtual std::optional<Frame> next() = 0;
  // Number of frames, 0 where it is not known beforehand.
  virtual std::int64_t size() const = 0;
  // What was recognised, for messages: "TUM RGB-D folder", "video with times.txt", ...
  virtual std::string kind() const = 0;
  // The calibration that lies beside the frames (camera.yaml, EuRoC's sensor.yaml), if there is one.
  virtual std::optional<Camera> camera() const = 0;
  // Size of the pictures of a video that brings its own times, as phones and webcams make them [px]; empty for others.
  virtual cv::Size videoSize() const { return {}; }
  // Path of the ground truth beside the frames (groundtruth.txt, EuRoC's state_groundtruth_estimate0/data.csv), or
  // empty.
  virtual std::string groundTruthPath() const = 0;
  // What an inertial unit measured, beside the frames.
  virtual InertialFiles inertialFiles() const { return {}; }
  // Path of what the wheels say beside the frames (wheel_odometry.txt), or empty.
  virtual std::string wheelOdometryPath() const { return ""; }
  // The live run that these frames were recorded of; null where they are no recording of the flight recorder.
  virtual const Recording* recording() const { return nullptr; }
};

// What a folder holds, by the names of its files alone, in the order in which openFrames looks.
enum class FolderKind { tum, associations, euroc, stamped_video, video, images, none };

// Throws InputError where the folder cannot be listed.
FolderKind folderKind(const std::string& folder);

// Of recordings the frames alone: openFrameSource (recording/open_frame_source.h) knows them, too.
// Throws InputError where `path` is missing, empty or of no known kind, and where time stamps go back or repeat.
std::unique_ptr<FrameSource> openFrames(const std::string& path);

}  // namespace edgeslam
