// Frames that lie as single image files in a folder, and the lists that tell their time stamps.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "frames/frame_source.h"

namespace edgeslam {

struct StampedFile {
  std::int64_t time_ns = 0;
  std::string path;
};

// What lies beside the frames.
struct FrameCompanions {
  std::optional<Camera> camera;
  std::string camera_path;  // empty where there is no calibration
  std::string ground_truth_path;
  InertialFiles inertial_files;
  std::string wheel_odometry_path;
};

// TUM RGB-D's rgb.txt ("time file" a line, seconds) and the associations.txt of TUM and ICL-NUIM, whose four columns
// name a colour and a depth image in either order. Files are relative to the list's folder. A last line that a
// power cut tore (no line end) is left out, where it is none. Throws InputError with file and line.
std::vector<StampedFile> readTumImageList(const std::string& list_path);

// EuRoC's data.csv ("time [ns],file" a line); files lie in data/ beside it. Throws InputError with file and line.
std::vector<StampedFile> readEurocImageList(const std::string& csv_path);

// Images of a folder named by their time stamps: seconds with a decimal point, or whole nanoseconds of 1e15 or more.
// Throws InputError where a name is neither, or two have the same time.
std::vector<StampedFile> imagesNamedByTime(const std::string& folder);

// True for the customary extensions of image files.
bool isImageFileName(const std::string& name);

std::unique_ptr<FrameSource> makeFolderSource(std::string kind, std::vector<StampedFile> files,
                                              FrameCompanions companions);

}  // namespace edgeslam
