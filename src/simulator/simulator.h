// Simulated sequences for tests and the demo: a scene, a hand-held camera, its lens and its sensor; with exact ground
// truth.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "geometry/camera.h"
#include "geometry/pose.h"
#include "simulator/hand_motion.h"
#include "simulator/image_sensor.h"
#include "simulator/scene.h"
#include "simulator/scene_renderer.h"

namespace edgeslam {

// Frames first, first + 1, ... first + count - 1.
struct FrameRange {
  int first = 0;
  int count = 0;
  bool contains(int index) const { return index >= first && index - first < count; }
};

// "FIRST:COUNT". Throws InputError for anything else.
FrameRange parseFrameRange(const std::string& text);

struct SimulationOptions {
  SceneKind scene = SceneKind::panels;
  int frames = 0;                   // 0: the scene's own length: 300, for the corridor a lap and a little more
  std::uint64_t seed = 1;           // of the posters, the hand and the noise
  double fps = 30;                  // [1/s]
  int width = 640;                  // [px]
  int height = 480;                 // [px]
  bool fisheye = false;             // Kannala-Brandt in place of pinhole with radial-tangential distortion
  double exposure_ms = 8;           // 0: no motion blur
  double readout_ms = 0;            // from the first row to the last; 0: a global shutter; negative: from below
  double noise = 2.0;               // standard deviation at grey 128 [grey]
  double speed = 1;                 // of the camera on its path, 1: the scene's usual speed
  std::vector<FrameRange> covered;  // a hand on the lens
  std::vector<FrameRange> shaken;   // shaken violently
  std::vector<FrameRange> still;    // not moved at all
  std::vector<FrameRange> turned;   // turned on the spot, to the side and back ...
  double turn_deg = 40;             // ... so far
  bool inertia = false;             // an inertial unit is on the camera
  bool wheels = false;              // a robot on wheels carries it ...
  std::vector<FrameRange> slipped;  // ... which spin
};

struct SimulatedFrame {
  std::int64_t time_ns = 0;  // middle of the middle row's exposure
  cv::Mat grey;              // CV_8U
  Pose world_T_camera;       // at that time
};

// Frames are rendered when they are asked for, in any order; each depends on the options and its index alone.
struct SimulatedSequence {
  SimulationOptions options;  // with the number of frames filled in
  Camera camera;
  LitScene scene;
  CameraMotion motion;
  RayTable rays;
  std::vector<double> gains;  // one a frame

  int size() const { return options.frames; }
  std::int64_t time(int index) const;  // [ns]
  Pose groundTruth(int index) const;   // world_T_camera
  SimulatedFrame frame(int index) const;
};

// Throws InputError, naming the option, for values out of range.
SimulatedSequence makeSequence(const SimulationOptions& options);

}  // namespace edgeslam
