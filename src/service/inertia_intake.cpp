#include "service/inertia_intake.h"

#include <string>

#include "files/format_text.h"

namespace edgeslam {

InertiaIntake::InertiaIntake(ImuReceiver& receiver, std::int64_t offset_ns, CaptureLink& link, EventLog& log)
    : receiver_(receiver), link_(link), log_(log), watch_(offset_ns) {}

void InertiaIntake::take(const Capture& captured, LiveRun& run) {
  while (const std::optional<InertialSample> sample = receiver_.next()) {
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

// The status has it each second; the log where it is another problem.
void InertiaIntake::tell() {
  std::string problem = watch_.problem();
  if (!problem.empty()) {
    const std::int64_t ignored = receiver_.ignored();
    problem = "inertial unit: " + problem +
              (ignored == 0 ? "" : " (" + std::to_string(ignored) + " messages were nothing that a unit measures)");
  }
  link_.setInertiaProblem(problem);
  if (withoutDigits(problem) == withoutDigits(told_)) return;
  log_.tell(problem.empty() ? "inertial unit: gives what is needed" : problem);
  told_ = problem;
}

}  // namespace edgeslam
