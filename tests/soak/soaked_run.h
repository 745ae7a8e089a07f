// A live run that is fed as fast as it follows, and held to what it must do with every frame.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "frames/frame_source.h"
#include "pipeline/live_run.h"
#include "soak/soak_truth.h"

namespace edgeslam {

// Over all runs of the process.
struct SoakTotals {
  std::int64_t frames = 0;   // handed over
  std::int64_t time_ns = 0;  // of the last one: goes on from run to run
  std::int64_t unreadable = 0;
  std::vector<std::string> problems;  // each a way in which a run did not do what it must
};

class SoakedRun {
 public:
  SoakedRun(const Camera& camera, SoakTotals& totals);

  // `map`: to go on with; may be empty.
  void begin(Map map);
  // The next frame, `step_ns` after the last; waits until tracking has it and mapping follows. Each 499th is told as
  // unreadable. `truth`: the camera's centre [m], where it is known.
  void feed(const cv::Mat& grey, std::int64_t step_ns, const std::optional<Eigen::Vector3d>& truth);
  // Waits until all is done, and compares what came out with what went in. The map is left.
  Map end();

  // Those that were called good, of frames whose truth is known; once the run has ended.
  const std::vector<JudgedPose>& judged() const { return judged_; }

  LiveCounts counts() const { return run_.counts(); }
  // Of the frames since this was last asked [ms], in order of size.
  std::vector<double> takeLatencies(std::int64_t& good_frames);

 private:
  void receive(const FrameResult& result, const std::string& problem);
  void note(const std::string& problem);

  SoakTotals& totals_;
  std::mutex mutex_;  // of what follows: the publishing thread writes, the feeding one reads
  struct Expected {
    std::int64_t time_ns = 0;
    std::optional<Eigen::Vector3d> truth;
  };
  std::map<std::int64_t, Expected> expected_;  // by index, of frames that are under way
  std::vector<JudgedPose> judged_;
  std::vector<double> latencies_ms_;
  std::int64_t good_frames_ = 0, received_ = 0, unreadable_ = 0, last_index_ = -1;

  std::int64_t handed_ = 0, handed_unreadable_ = 0;
  Camera camera_;
  LiveRun run_;
};

}  // namespace edgeslam
