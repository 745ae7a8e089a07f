// What the page is sent: one byte for the kind, then JSON or little-endian binary. The page's stream.js reads it.
//
// `picture` and `map` are a length (uint32, bytes), JSON of that length with the numbers of what follows, and that:
//   picture: the JPEG; tracks of 12 bytes (x, y, x in the latest keyframe, y there: uint16 [1/16 px]; the edge's normal
//            x, y: int8 [1/127]; flags: 1 corner, 2 mapped, 4 outlier; 0); edge points of 4 bytes (x, y: uint16
//            [1/16 px]; 65535, 65535: the next point begins another line).
//   map:     what changed since the map sent before, whose number is `after` (0: nothing was sent yet). Points and
//            keyframes are lists, put together of runs: pairs of uint32, where the run begins in the list before
//            (0xffffffff: it is of the new ones) and its length. First the points' runs, then the keyframes'; then
//            what is new: positions (3 float32 a point, world [map units]), keyframes of 7 float32 (position; rotation
//            x, y, z, w; world_T_camera), and of each point grey value (uint8), standard deviation of the depth (uint8
//            [%]), join (uint8, 1: a line comes from the point before). See viewed_map.h.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/lcm/body_pose.h"
#include "drivers/lcm/status_message.h"
#include "geometry/camera.h"
#include "pipeline/frame_look.h"

namespace edgeslam {

enum class ViewMessage : std::uint8_t { hello = 1, state = 2, map = 3, picture = 4 };
constexpr std::size_t view_messages = 4;

// What does not change while the program runs.
struct ViewerSetup {
  std::string version;
  std::string source;  // camera or recording, in words
  Camera camera;
  std::vector<std::string> commands;  // names that make sense here
};

// One frame's figures, for the graphs.
struct FrameSample {
  std::int64_t utime = 0;  // of the frame [us]
  TrackingState state = TrackingState::initialising;
  double latency_ms = 0;   // from capture to the pose
  double tracking_ms = 0;  // tracking's own time
};

// As of now.
struct ViewedState {
  FrameResult frame;  // the latest
  bool has_frame = false;
  PublisherStatus status;
  ScaleState scale;
  std::string lcm_problem;  // why messages do not go out; or empty
  std::string note;         // for the person who looks on; or empty
};

std::string helloMessage(const ViewerSetup& setup);

// Numbers that are not finite are null.
std::string stateMessage(const ViewedState& state, const std::vector<FrameSample>& samples);

// Images wider than most_picture_width are sent at half or a quarter of their size; the tracks' pixels are those of the
// whole one. Empty where the look has no image.
std::string pictureMessage(const FrameLook& look);

constexpr int most_picture_width = 960;  // [px]

}  // namespace edgeslam
