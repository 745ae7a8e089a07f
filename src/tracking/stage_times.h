// How long the stages of one frame took.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>

namespace edgeslam {

enum class Stage { pyramid, edges, alignment, flow, pose, refinement, map_reuse, choice_of_points, mapping, places };

constexpr std::array<Stage, 10> all_stages{Stage::pyramid, Stage::edges,      Stage::alignment, Stage::flow,
                                           Stage::pose,    Stage::refinement, Stage::map_reuse, Stage::choice_of_points,
                                           Stage::mapping, Stage::places};

// "pyramid", "map reuse", ...
const char* stageName(Stage stage);

class StageTimes {
 public:
  StageTimes() { milliseconds_.fill(-1); }

  bool ran(Stage stage) const { return milliseconds_[static_cast<std::size_t>(stage)] >= 0; }
  // 0 where it did not run [ms].
  double operator[](Stage stage) const { return ran(stage) ? milliseconds_[static_cast<std::size_t>(stage)] : 0.0; }
  // A stage that ran twice adds up.
  void add(Stage stage, double milliseconds) {
    milliseconds_[static_cast<std::size_t>(stage)] = static_cast<float>((*this)[stage] + milliseconds);
  }
  double total() const;

 private:
  std::array<float, all_stages.size()> milliseconds_;  // negative: it did not run
};

// Adds the time since the last call, or since it was made, to a stage.
class StageClock {
 public:
  explicit StageClock(StageTimes& times) : times_(times), last_(std::chrono::steady_clock::now()) {}

  void finished(Stage stage) {
    const auto now = std::chrono::steady_clock::now();
    times_.add(stage, std::chrono::duration<double, std::milli>(now - last_).count());
    last_ = now;
  }

 private:
  StageTimes& times_;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace edgeslam
