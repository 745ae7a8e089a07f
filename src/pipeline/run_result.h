// What a run leaves: a record a frame, the keyframes, the map, and what is needed to explain them in files and in the
// report.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "geometry/found_camera.h"
#include "geometry/pose.h"
#include "inertia/found_time_offset.h"
#include "inertia/found_unit_rotation.h"
#include "inertia/inertial_alignment.h"
#include "pipeline/duration_statistics.h"
#include "tracking/frame_result.h"
#include "wheels/wheel_scale.h"

namespace edgeslam {

// A frame's result as it was given out at the time, and what became of it.
struct FrameRecord : FrameResult {
  bool has_final_pose = false;  // good, and in the map as it came to be (final_poses.h)
  int final_world = -1;         // that the final pose is in, after all joining; -1: none
  Pose final_world_T_camera;
  bool is_keyframe = false;
  bool has_odometry = false;
  Pose odom_T_camera;  // in the frame that never jumps (visual_odometry/odometry_frame.h)
  int odometry_resets = 0;
};

struct KeyframeRecord {
  int id = 0;
  int world = 0;
  std::int64_t frame_index = 0;
  std::int64_t time_ns = 0;
  Pose world_T_camera;  // final
  std::string reason;   // which criterion chose it (P8 to P12)
  int shared_points = 0;
};

struct MapPointRecord {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();        // world, map units
  Eigen::Vector3d edge_direction = Eigen::Vector3d::Zero();  // world, unit; zero for a corner-like point
  int chain = -1;               // points of one image edge share a number; unique over the map
  int order = 0;                // place along the chain
  float depth_sigma_ratio = 0;  // standard deviation of the depth over the depth
  unsigned char grey = 0;       // of the image there
  std::int64_t id = 0;          // in the map
  int world = 0;
};

// A straight edge that is a landmark of the map: what keyframes saw of it.
struct MapLineRecord {
  Eigen::Vector3d from = Eigen::Vector3d::Zero(), to = Eigen::Vector3d::Zero();  // its ends: world, map units
  int keyframes = 0;                                                             // that see it
  std::int64_t id = 0;                                                           // in the map
  int world = 0;
};

// A frame with its edges and tracks, for the report.
struct DrawnFrame {
  std::int64_t index = 0;
  cv::Mat image;  // CV_8UC3 (BGR)
};

struct TimedPose {
  std::int64_t time_ns = 0;
  Pose world_T_camera;
};

// A place that was met again, and the keyframes before and after the drift was shared out.
struct ClosedLoop {
  std::int64_t frame_index = 0;
  int keyframe = -1;  // that met it
  std::string how;    // "by its looks" (P23 to P27), "by its points" (map reuse)
  std::vector<TimedPose> before, after;
};

struct RunResult {
  Camera camera;                               // with what was found of it
  FoundCamera found;                           // beside its calibration
  std::optional<FoundTimeOffset> time_offset;  // of the inertial unit's clock, where it is not the one that was given
  std::optional<FoundUnitRotation> unit_rotation;  // how the unit is turned against the camera, likewise
  std::deque<FrameRecord> frames;                  // grows without moving what is there
  // Of all worlds: maps that could not be joined, each with a coordinate frame and a unit of its own.
  std::vector<KeyframeRecord> keyframes;
  std::vector<MapPointRecord> map_points;
  std::vector<MapLineRecord> map_lines;
  // Worlds whose lengths are metres and whose z is up, by inertia; and how their map lay to that.
  std::map<int, InertialAlignment> inertia;
  std::map<int, WheelScale> wheels;     // worlds whose lengths are metres, by the wheels; and how long their unit was
  std::string lacking_for_wheels;       // as of inertia
  std::string contradiction_of_wheels;  // what is amiss between them and the camera, in words; or empty
  std::string lacking_for_inertia;      // why the last world is none of them; empty where it is, or there was no unit
  int main_world = 0;                   // the one with most final poses; of several the earliest
  std::vector<DrawnFrame> drawings;
  std::vector<std::string> events;  // recoveries, relocalisations, loops accepted and refused: "frame 120: ..."
  int recoveries = 0;               // P21
  int relocalisations = 0;          // P22
  std::vector<ClosedLoop> closed_loops;
  std::string initialisation;  // how the map was started: method, pair, quality factor
  std::int64_t unreadable_frames = 0;
  std::int64_t dropped_frames = 0;  // of a live run
  double wall_s = 0;                // of the whole run
  double pace = 0;  // of a live run: how many times as fast as the time stamps frames came; 0: it was not one
  // Of a live run: how long each thread's work took and how long it waited in the queue before it.
  std::vector<DurationSummary> thread_durations;
};

}  // namespace edgeslam
