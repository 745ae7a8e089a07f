// The metric scale from a known distance: between two frames that had a pose the camera moved so many metres.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scale/measured_pose.h"
#include "scale/scale_options.h"
#include "scale/scale_state.h"
#include "tracking/frame_result.h"

namespace edgeslam {

// Where the camera was at the latest frames with a measured pose.
class PositionHistory {
 public:
  explicit PositionHistory(std::size_t capacity = 20000);  // over 10 min at 30 frames/s, 2 MB

  void add(const FrameResult& result);
  // The map was corrected, or is another one: positions before and after do not go together.
  void clear() { count_ = 0; }

  struct Position {
    std::int64_t utime = 0;                                // of the frame [us]
    int world = 0;                                         // that it is in
    Eigen::Vector3d position = Eigen::Vector3d::Zero();    // of the camera, world [map units]
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // world
  };
  // Of the frame of this time stamp; null where it had no measured pose, or is too long ago.
  const Position* find(std::int64_t utime) const;

 private:
  std::vector<Position> positions_;  // a ring, time stamps ascending
  std::size_t next_ = 0, count_ = 0;
};

struct ScaleResult {
  ScaleState scale;     // where there is no problem
  std::string problem;  // why not, and what would do
  int world = 0;        // whose scale it is
};

// `distance_m`: over 0.
ScaleResult scaleFromDistance(const PositionHistory& history, std::int64_t from_utime, std::int64_t to_utime,
                              double distance_m, const ScaleOptions& options);

}  // namespace edgeslam
