#include "frames/frame_source.h"

#include <algorithm>
#include <filesystem>
#include <vector>

#include "frames/calibration_file.h"
#include "frames/folder_source.h"
#include "frames/video_source.h"

namespace edgeslam {
namespace {

namespace fs = std::filesystem;

bool isFile(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

// Names of the files in a folder, sorted.
std::vector<std::string> fileNames(const fs::path& folder) {
  std::error_code error;
  std::vector<std::string> names;
  fs::directory_iterator entries(folder, error);
  if (error) throw InputError(folder.string() + ": cannot be listed: " + error.message());
  for (const fs::directory_entry& entry : entries) {
    if (isFile(entry.path())) names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

bool isCameraChain(const std::string& name) {
  return name.rfind("camchain", 0) == 0 && fs::path(name).extension() == ".yaml";
}

// The calibration in one of the folders, looked for in order; empty where there is none.
std::string findCalibration(const std::vector<fs::path>& folders) {
  for (const fs::path& folder : folders) {
    for (const char* name : {"camera.yaml", "camera_info.yaml"}) {
      if (isFile(folder / name)) return (folder / name).string();
    }
    const std::vector<std::string> names = fileNames(folder);
    const auto chain = std::find_if(names.begin(), names.end(), isCameraChain);
    if (chain != names.end()) return (folder / *chain).string();
    if (isFile(folder / "sensor.yaml")) return (folder / "sensor.yaml").string();
  }
  return "";
}

// imu.csv and imu.yaml, or EuRoC's imu0, in one of the folders, looked for in order.
InertialFiles findInertialFiles(const std::vector<fs::path>& folders) {
  for (const fs::path& folder : folders) {
    const fs::path unit = folder / "imu.yaml";
    if (isFile(folder / "imu.csv")) return {(folder / "imu.csv").string(), isFile(unit) ? unit.string() : "", ""};
    const fs::path euroc = folder / "imu0";
    const fs::path sensor = euroc / "sensor.yaml", camera = folder / "cam0" / "sensor.yaml";
    if (isFile(euroc / "data.csv") && isFile(sensor) && isFile(camera)) {
      return {(euroc / "data.csv").string(), sensor.string(), camera.string()};
    }
  }
  return {};
}

FrameCompanions findCompanions(const std::vector<fs::path>& folders) {
  FrameCompanions companions;
  companions.camera_path = findCalibration(folders);
  if (!companions.camera_path.empty()) companions.camera = readCalibration(companions.camera_path);
  companions.inertial_files = findInertialFiles(folders);
  for (const fs::path& folder : folders) {
    if (companions.wheel_odometry_path.empty() && isFile(folder / "wheel_odometry.txt")) {
      companions.wheel_odometry_path = (folder / "wheel_odometry.txt").string();
    }
  }
  for (const fs::path& folder : folders) {
    for (const char* name : {"groundtruth.txt", "state_groundtruth_estimate0/data.csv"}) {
      if (isFile(folder / name) && companions.ground_truth_path.empty()) {
        companions.ground_truth_path = (folder / name).string();
      }
    }
    for (const std::string& name : fileNames(folder)) {
      const bool is_icl_nuim = fs::path(name).extension() == ".freiburg";
      if (is_icl_nuim && companions.ground_truth_path.empty()) companions.ground_truth_path = (folder / name).string();
    }
  }
  return companions;
}

// EuRoC's cam0, whether the folder given is the sequence, its mav0, or cam0 itself; empty where it is none of them.
fs::path findEurocCamera(const fs::path& folder) {
  for (const fs::path& camera : {folder / "mav0" / "cam0", folder / "cam0", folder}) {
    if (isFile(camera / "data.csv") && fs::is_directory(camera / "data")) return camera;
  }
  return {};
}

std::vector<std::string> videosIn(const fs::path& folder) {
  const std::vector<std::string> names = fileNames(folder);
  std::vector<std::string> videos;
  std::copy_if(names.begin(), names.end(), std::back_inserter(videos), isVideoFileName);
  return videos;
}

std::unique_ptr<FrameSource> openEuroc(const fs::path& folder) {
  const fs::path camera = findEurocCamera(folder);
  // The ground truth lies beside cam0, and a calibration of the user's own beside mav0.
  std::vector<fs::path> folders{camera};
  if (camera != folder) folders.push_back(camera.parent_path());
  if (folders.back() != folder) folders.push_back(folder);
  if (camera == folder) folders.push_back(fs::absolute(folder / "").parent_path().parent_path());
  return makeFolderSource("EuRoC folder", readEurocImageList((camera / "data.csv").string()), findCompanions(folders));
}

std::unique_ptr<FrameSource> openVideoFolder(const fs::path& folder) {
  const std::vector<std::string> videos = videosIn(folder);
  if (videos.size() > 1) {
    throw InputError(folder.string() + ": holds several videos (" + videos[0] + ", " + videos[1] +
                     "); give the path of one of them");
  }
  const std::string video = (folder / videos[0]).string();
  const fs::path times = folder / "times.txt";
  if (isFile(times)) return makeStampedVideoSource(video, times.string(), findCompanions({folder}));
  return makeVideoSource(video, findCompanions({folder}));
}

std::unique_ptr<FrameSource> openFolder(const fs::path& folder) {
  switch (folderKind(folder.string())) {
    case FolderKind::tum:
      return makeFolderSource("TUM RGB-D folder", readTumImageList((folder / "rgb.txt").string()),
                              findCompanions({folder}));
    case FolderKind::associations:
      return makeFolderSource("TUM RGB-D folder (associations.txt)",
                              readTumImageList((folder / "associations.txt").string()), findCompanions({folder}));
    case FolderKind::euroc:
      return openEuroc(folder);
    case FolderKind::stamped_video:
    case FolderKind::video:
      return openVideoFolder(folder);
    case FolderKind::images:
      return makeFolderSource("folder of images", imagesNamedByTime(folder.string()), findCompanions({folder}));
    case FolderKind::none:
      break;
  }
  throw InputError(folder.string() + (fs::is_empty(folder) ? ": is an empty folder" : ": holds no frames") +
                   "; expected recording.txt (a recording), rgb.txt (TUM RGB-D), associations.txt (ICL-NUIM), "
                   "mav0/cam0 (EuRoC), a video, or images " +
                   "named by their time stamps");
}

}  // namespace

FolderKind folderKind(const std::string& folder) {
  const fs::path path(folder);
  if (isFile(path / "rgb.txt")) return FolderKind::tum;
  if (isFile(path / "associations.txt")) return FolderKind::associations;
  if (!findEurocCamera(path).empty()) return FolderKind::euroc;
  const std::vector<std::string> names = fileNames(path);
  if (std::any_of(names.begin(), names.end(), isVideoFileName)) {
    return isFile(path / "times.txt") ? FolderKind::stamped_video : FolderKind::video;
  }
  return std::any_of(names.begin(), names.end(), isImageFileName) ? FolderKind::images : FolderKind::none;
}

std::unique_ptr<FrameSource> openFrames(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) throw InputError(path + ": no such folder or video");
  if (fs::is_directory(status)) return openFolder(path);
  // FFmpeg would play a text file, too, as a film of its letters.
  if (!isVideoFileName(fs::path(path).filename().string())) {
    throw InputError(path + ": expected a folder of frames or a video file (.mp4, .mkv, .avi, .mov, ...)");
  }
  const fs::path folder = fs::path(path).parent_path();
  return makeVideoSource(path, findCompanions({folder.empty() ? fs::path(".") : folder}));
}

}  // namespace edgeslam
