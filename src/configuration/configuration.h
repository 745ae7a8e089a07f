// The configuration file: all settings of the method, and the camera with its place on the robot (design, section 6).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/frame_capture/camera_options.h"
#include "drivers/lcm/lcm_options.h"
#include "drivers/ros2/ros2_options.h"
#include "drivers/viewer/viewer_options.h"
#include "edgeslam/input_error.h"
#include "geometry/camera_mask.h"
#include "geometry/pose.h"
#include "inertia/inertial_unit.h"
#include "pipeline/settings.h"
#include "scale/scale_options.h"

namespace edgeslam {

// How `edgeslam run` publishes, and what it keeps on the disk.
struct ServiceOptions {
  LcmOptions lcm;
  double map_interval_s = 5;      // the map is sent at most so often where it changed; 0: on request only
  std::string map_file;           // written at the end, on SIGHUP and on command; empty: nowhere
  bool goes_on_with_map = false;  // at the start, with the map in the file, where there is one
  std::string recordings_folder;  // for a folder a recording; empty: no command begins one
  bool records_from_start = false;
  ScaleOptions scale;
  ViewerOptions viewer;
  Ros2Options ros2;
};

// The inertial unit that is fixed to the camera.
struct InertiaConfiguration {
  bool is_used = false;
  std::string channel = "IMU";  // of LCM, for live runs
  bool has_unit = false;        // the file says where it sits; otherwise `unit` has only its noise
  InertialUnit unit;
  double time_offset_s = 0;  // as unit.offset_ns
};

struct Configuration {
  Settings settings;
  std::optional<Camera> camera;  // where the file gives one
  std::string camera_doubt;      // what is to be told of its calibration (doubtfulDistortion)
  // Where the file gives it without a calibration: instead of that of whatever calibration is taken.
  std::optional<double> readout_s;
  bool has_readout = false;                // the file gives camera.readout, by itself or beside the calibration
  std::shared_ptr<const CameraMask> mask;  // of the camera that is taken, `camera` or another; null: none
  std::string mask_path;                   // absolute; of its image
  Pose body_T_camera;     // of the camera on the robot, translation [m]; the identity unless the file gives it
  CameraOptions capture;  // the live camera
  InertiaConfiguration inertia;
  ServiceOptions service;
  std::string source;  // path of the file; empty for the defaults
};

// What is to be told where the lens is presumed; empty where it is not.
std::string presumedLens(const Configuration& configuration);

// What is to be told where a calibration's distortion cannot be right over the whole image; empty where it can.
std::string doubtfulDistortion(const Camera& camera);

// Why the configuration's mask cannot be that of the camera: `camera.mask: ...`; empty where it can, or there is none.
std::string maskProblem(const Camera& camera, const Configuration& configuration);

// The camera with what the configuration gives of it by itself, its readout and its mask, and with a distortion that
// can be believed. Throws InputError where there is a maskProblem().
Camera asConfigured(Camera camera, const Configuration& configuration);

// The camera with the readout that was found with the inertial unit, where that is used and its own calibration has
// none.
Camera withReadoutOfUnit(Camera camera, const Configuration& configuration);

// The settings with the inertial unit and the wheels, where these are to be used. Throws InputError where it is not
// known where the unit sits.
Settings settingsWithSensors(const Configuration& configuration);

// An empty file gives the defaults; an included file is read first. Throws InputError `FILE:LINE: KEY: ...` at the
// first problem.
Configuration readConfiguration(const std::string& path);

// The same, but collects all problems, one line each in the order of the file, and throws nothing: where there are any,
// the configuration is not to be used.
Configuration readConfiguration(const std::string& path, std::vector<std::string>& problems);

// True where the file is a camera's calibration rather than a configuration; false also where it cannot be read.
bool isCalibrationFile(const std::string& path);

}  // namespace edgeslam
