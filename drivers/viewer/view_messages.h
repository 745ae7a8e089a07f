// What the page is sent: one byte for the kind, then JSON or little-endian binary. The page's stream.js reads it.
//
// `picture` and `map` are a length (uint32, bytes), JSON of that length with the numbers of what follows, and that:
//   picture: the JPEG; tracks of 12 bytes (x, y, x in the latest keyframe, y there: uint16 [1/16 px]; the edge's normal
//            x, y: int8 [1/127]; flags: 1 corner, 2 mapped, 4 outlier; 0); edge points of 4 bytes (x, y: uint16
//            [1/16 px]; 65535, 65535: the next point begins another line).
//   map:     positions (3 float32 a point, world [map units]), grey values (uint8), standard deviations of the
//            depth (uint8 [%]), joins (uint8, 1: a line comes from the point before), keyframes of 7 float32 (position;
//            rotation x, y, z, w; world_T_camera).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/lcm/body_pose.h"
#include "drivers/lcm/status_message.h"
#include "geometry/camera.h"
#include "map/map.h"
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

// At most most_viewed_points of the map's points, spread evenly, and most_viewed_keyframes; points that are not finite
// are left out.
std::string mapMessage(const Map& map, const Camera& camera);

constexpr int most_picture_width = 960;  // [px]
constexpr std::size_t most_viewed_points = 20000;
constexpr std::size_t most_viewed_keyframes = 2000;

}  // namespace edgeslam
