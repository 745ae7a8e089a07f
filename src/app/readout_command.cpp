#include "app/readout_command.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iostream>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "app/command_line.h"
#include "calibration/readout_search.h"
#include "configuration/configuration.h"
#include "configuration/input_configuration.h"
#include "files/format_text.h"
#include "frames/frame_problem.h"
#include "geometry/median.h"
#include "pipeline/lockstep_run.h"
#include "recording/open_frame_source.h"

namespace edgeslam {
namespace {

constexpr std::int64_t most_frames = 1000;  // from the start on
constexpr double longest_readout_tried_s = 0.05;
constexpr std::size_t most_threads = 4;

ReadoutTrial tryReadout(const std::string& recording, const Camera& camera, const Settings& settings) {
  const std::unique_ptr<FrameSource> source = openFrameSource(recording);
  LockstepRun run(camera, settings, source->size(), 0);
  ReadoutTrial trial;
  trial.readout_s = camera.readout_s;
  for (std::int64_t count = 0; count < most_frames; ++count) {
    const std::optional<Frame> frame = source->next();
    if (!frame) break;
    const std::string problem = frameProblem(*frame, camera);
    const FrameRecord& record = problem.empty() ? run.process(frame->index, frame->time_ns, frame->grey)
                                                : run.skip(frame->index, frame->time_ns, problem);
    trial.errors.push_back(record.measured_noise);
  }
  return trial;
}

Settings withoutFinding(Settings settings) {
  settings.mapping.camera_finding.is_enabled = false;
  return settings;
}

// The trials of a search side by side, each in a thread.
class Trials {
 public:
  Trials(const std::string& recording, const Camera& camera, const Settings& settings)
      : recording_(recording), camera_(camera), settings_(withoutFinding(settings)) {}

  std::vector<ReadoutTrial> of(const std::vector<double>& readouts_s) {
    std::vector<ReadoutTrial> trials(readouts_s.size());
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
      for (std::size_t i = next++; i < trials.size(); i = next++) {
        Camera camera = camera_;
        camera.readout_s = readouts_s[i];
        trials[i] = tryReadout(recording_, camera, settings_);
        tell(trials[i]);
      }
    };
    std::vector<std::thread> threads;
    const std::size_t most = std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1, most_threads);
    for (std::size_t i = 1; i < std::min(most, trials.size()); ++i) threads.emplace_back(work);
    work();
    for (std::thread& thread : threads) thread.join();
    return trials;
  }

 private:
  void tell(const ReadoutTrial& trial) {
    std::vector<double> told;
    std::copy_if(trial.errors.begin(), trial.errors.end(), std::back_inserter(told), [](double e) { return e > 0; });
    const std::lock_guard<std::mutex> lock(mutex_);
    std::cerr << formatted("readout %.0f ms: %zu of %zu frames see the map", 1e3 * trial.readout_s, told.size(),
                           trial.errors.size());
    if (!told.empty()) std::cerr << formatted(", median error %.2f of a good camera's", upperMedian(told));
    std::cerr << std::endl;
  }

  const std::string& recording_;
  const Camera& camera_;
  Settings settings_;
  std::mutex mutex_;
};

// Median time from one frame to the next [s].
double frameInterval(const std::string& recording) {
  const std::unique_ptr<FrameSource> source = openFrameSource(recording);
  std::vector<double> intervals;
  std::int64_t before_ns = 0;
  for (int count = 0; count < 60; ++count) {
    const std::optional<Frame> frame = source->next();
    if (!frame) break;
    if (count > 0) intervals.push_back(static_cast<double>(frame->time_ns - before_ns) * 1e-9);
    before_ns = frame->time_ns;
  }
  if (intervals.empty()) throw InputError(recording + ": a readout cannot be found from fewer than two frames");
  return upperMedian(intervals);
}

}  // namespace

int findReadout(const std::string& recording, const std::string& configuration_file) {
  const std::unique_ptr<FrameSource> source = openFrameSource(recording);
  const Configuration configuration = configurationFor(*source, configuration_file);
  const Camera camera = cameraFor(*source, configuration, recording);
  if (configuration.settings.mapping.camera_finding.lens_is_presumed) {
    const std::string& named = configuration.source.empty() ? recording : configuration.source;
    throw InputError(named + ": only the camera's size is known; its readout needs a calibration");
  }
  const double longest_s = std::min(frameInterval(recording), longest_readout_tried_s);
  Trials trials(recording, camera, configuration.settings);
  const ReadoutEstimate estimate =
      searchReadout(longest_s, [&](const std::vector<double>& readouts_s) { return trials.of(readouts_s); });
  if (!estimate.problem.empty()) {
    std::cerr << "edgeslam: " << recording << ": the recording does not tell the readout: " << estimate.problem << "\n";
    return exit_failed;
  }
  std::cout << formatted("readout: %.4f   # [s], +- %.4f; errors %.2f with it, %.2f with a global shutter\n",
                         estimate.readout_s, estimate.sigma_s, estimate.error_best, estimate.error_global);
  if (std::abs(estimate.readout_s) < 2 * estimate.sigma_s) {
    std::cout << "# as good as a global shutter: the key is not needed\n";
  } else {
    std::cout << "# put this line into the camera's calibration (camera.yaml)\n";
  }
  return exit_done;
}

}  // namespace edgeslam
