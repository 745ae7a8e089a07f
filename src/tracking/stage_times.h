// How long the stages of one frame took.
#pragma once

#include <chrono>
#include <utility>
#include <vector>

namespace edgeslam {

// (name of the stage, milliseconds), in the order in which they ran; a stage that ran twice adds up.
using StageTimes = std::vector<std::pair<const char*, double>>;

// Adds the time since the last call, or since it was made, to a stage.
class StageClock {
 public:
  explicit StageClock(StageTimes& times) : times_(times), last_(std::chrono::steady_clock::now()) {}

  void finished(const char* stage) {
    const auto now = std::chrono::steady_clock::now();
    const double elapsed_ms = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    for (auto& [name, total_ms] : times_) {
      if (name == stage) {
        total_ms += elapsed_ms;
        return;
      }
    }
    times_.emplace_back(stage, elapsed_ms);
  }

 private:
  StageTimes& times_;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace edgeslam
