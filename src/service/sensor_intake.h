// What a sensor of the robot's gives beside the camera, its inertial unit or its wheels, on its way into the run, and
// what is told of it.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "drivers/frame_capture/reopening_camera.h"
#include "files/format_text.h"
#include "pipeline/live_run.h"
#include "service/capture_link.h"
#include "service/event_log.h"

namespace edgeslam {

// What a sensor is called in messages, and what those are that it sends and nobody can use.
struct SensorName {
  std::string name, useless;
};

// For the capture thread. `Receiver`: a MessageReceiver; `Watch`: of its samples, InertialWatch or WheelWatch.
template <typename Receiver, typename Watch>
class SensorIntake {
 public:
  // Receiver, link and log outlive it.
  SensorIntake(SensorName name, Receiver& receiver, Watch watch, CaptureLink& link, EventLog& log)
      : name_(std::move(name)), receiver_(receiver), watch_(std::move(watch)), link_(link), log_(log) {}

  // Before a frame goes into the run: all that has come. Never waits.
  void take(const Capture& captured, LiveRun& run) {
    while (const auto sample = receiver_.next()) {
      watch_.add(*sample);
      run.add(*sample);
    }
    if (captured.event != CaptureEvent::frame) return;
    watch_.addFrame(captured.frame.time_ns);
    constexpr std::int64_t second_ns = 1'000'000'000;
    if (captured.frame.time_ns < told_ns_ + second_ns) return;
    told_ns_ = captured.frame.time_ns;
    tell();
  }

 private:
  // The status has it each second; the log where it is another problem.
  void tell() {
    std::string problem = watch_.problem();
    if (!problem.empty()) {
      const std::int64_t ignored = receiver_.ignored();
      problem = name_.name + ": " + problem +
                (ignored == 0 ? "" : " (" + std::to_string(ignored) + " messages were " + name_.useless + ")");
    }
    link_.setSensorProblem(name_.name, problem);
    if (withoutDigits(problem) == withoutDigits(told_)) return;
    log_.tell(problem.empty() ? name_.name + ": gives what is needed" : problem);
    told_ = problem;
  }

  SensorName name_;
  Receiver& receiver_;
  Watch watch_;
  CaptureLink& link_;
  EventLog& log_;
  std::int64_t told_ns_ = 0;  // the frame at which it was last looked at what is wrong
  std::string told_;
};

}  // namespace edgeslam
