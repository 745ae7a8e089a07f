// How the inertial unit's clock differs from the camera's where that is not as it was given: looked for now and then
// while the camera turns, and taken where several looks say the same.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "inertia/found_time_offset.h"
#include "mapping/time_offset_estimate.h"

namespace edgeslam {

class TimeOffsetFinding {
 public:
  // With the offset that was given.
  explicit TimeOffsetFinding(const InertialUnit& unit) : unit_(unit) {}

  // What came with a keyframe of this time, in order. True where the offset is another one now.
  bool add(std::int64_t keyframe_ns, const std::vector<InertialSample>& felt, const std::vector<CameraTurn>& turns);

  // None: it is as given, as far as is known.
  const std::optional<FoundTimeOffset>& found() const { return found_; }
  // Samples that belong to a frame by what was found are there when it is tracked.
  bool comesInTime() const;
  // What the unit measured lately: times ascend.
  const std::vector<InertialSample>& samples() const { return samples_; }
  // The latest frames that it looks at: worlds are stretches in which no frame is missing.
  const std::vector<PosedCamera>& frames() const { return frames_; }
  // The unit is turned otherwise from now on. What the map was bent by before goes, if it was.
  void setRotation(const Eigen::Quaterniond& imu_R_camera, bool was_map_bent);

 private:
  void keepSamples(const std::vector<InertialSample>& felt);
  void keepTurns(const std::vector<CameraTurn>& turns);
  bool look();
  bool isToChange(const TimeOffsetEstimate& estimate);

  InertialUnit unit_;
  std::vector<InertialSample> samples_;
  std::vector<PosedCamera> frames_;  // latest ones; worlds are stretches in which no frame is missing
  std::optional<FoundTimeOffset> found_;
  std::array<std::int64_t, 5> ahead_ns_{};  // of keyframes so far samples had come, the latest ones: a ring
  std::size_t keyframes_ = 0;
  double since_look_s_ = 0;  // of turns
  int agreeing_ = 0;         // looks in a row, that say that it is another one ...
  double last_s_ = 0;        // ... and which
  int steady_ = 0;           // looks in a row that changed nothing
};

}  // namespace edgeslam
