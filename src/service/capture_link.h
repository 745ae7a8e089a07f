// Between the thread that captures frames and the one that publishes what becomes of them.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "drivers/lcm/commands.h"

namespace edgeslam {

class CaptureLink {
 public:
  struct Answer {
    Command command;
    bool accepted = false;
    std::string message;
  };

  // Capture's side. Why no frames come; empty once they come again.
  void setCameraProblem(const std::string& problem) {
    const std::lock_guard<std::mutex> lock(mutex_);
    camera_problem_ = problem;
  }
  // What is wrong with what the sensor of that name gives; empty where nothing is.
  void setSensorProblem(const std::string& sensor, const std::string& problem) {
    const std::lock_guard<std::mutex> lock(mutex_);
    sensor_problems_[sensor] = problem;
  }
  // There is no frame to be had at present, and capture is not stuck.
  void waited() { waits_.fetch_add(1, std::memory_order_relaxed); }
  // Frames that the camera lost or that newer ones overtook in its driver, and those that could not even be handed on.
  void lost(std::int64_t frames) { lost_.fetch_add(frames, std::memory_order_relaxed); }
  void askForMapToBeSaved() { save_map_.store(true, std::memory_order_relaxed); }
  // The command that capture is to carry out, and to answer().
  std::optional<Command> takeRequest() {
    if (!requested_.load(std::memory_order_acquire)) return std::nullopt;
    const std::lock_guard<std::mutex> lock(mutex_);
    requested_.store(false, std::memory_order_relaxed);
    return std::exchange(request_, std::nullopt);
  }
  void answer(const Command& command, bool accepted, const std::string& message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    underway_.reset();
    answers_.push_back({command, accepted, message});
  }

  // Publishing's side.
  std::string cameraProblem() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return camera_problem_;
  }
  // Of the first sensor that has one; or empty.
  std::string sensorProblem() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const auto& [sensor, problem] : sensor_problems_) {
      if (!problem.empty()) return problem;
    }
    return "";
  }
  std::int64_t waits() const { return waits_.load(std::memory_order_relaxed); }
  std::int64_t lost() const { return lost_.load(std::memory_order_relaxed); }
  std::vector<Answer> takeAnswers() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::exchange(answers_, {});
  }
  bool takeMapWish() { return save_map_.exchange(false, std::memory_order_relaxed); }
  // False where one is still being carried out.
  bool request(const Command& command) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (underway_) return false;
    underway_ = request_ = command;
    requested_.store(true, std::memory_order_release);
    return true;
  }
  // Whether it is the one that is being carried out, sent again for want of an answer.
  bool isUnderway(const Command& command) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return underway_ && underway_->id == command.id && underway_->kind == command.kind &&
           underway_->sender == command.sender;
  }

 private:
  mutable std::mutex mutex_;
  std::string camera_problem_;
  std::map<std::string, std::string> sensor_problems_;
  std::optional<Command> request_;
  std::optional<Command> underway_;  // requested and not answered yet
  std::vector<Answer> answers_;
  std::atomic<bool> requested_{false}, save_map_{false};
  std::atomic<std::int64_t> waits_{0}, lost_{0};
};

}  // namespace edgeslam
