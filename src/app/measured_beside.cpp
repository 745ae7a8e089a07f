#include "app/measured_beside.h"

#include <iostream>
#include <utility>

#include "frames/inertial_file.h"
#include "frames/wheel_file.h"
#include "inertia/sample_gap_watch.h"
#include "inertia/saturation_watch.h"
#include "recording/recording_source.h"

namespace edgeslam {
namespace {

// None of a recording that is repeated: what was measured is among its decisions.
template <typename Given, typename Sample>
std::vector<Sample> recorded(const Recording& recording, const std::vector<Given>& all, Sample Given::*sample,
                             bool is_live) {
  std::vector<Sample> samples;
  const bool is_repeated = !is_live && recording.decisions.not_recorded == 0;
  if (is_repeated) return samples;
  for (const Given& given : all) samples.push_back(given.*sample);
  return samples;
}

// What is wrong with them, but not so much that they cannot be used.
std::vector<InertialSample> toldOf(const InertialFiles& files, std::vector<InertialSample> samples) {
  for (const std::string& problem : {sampleGapProblem(samples), saturationProblem(samples)}) {
    if (!problem.empty()) std::cerr << "edgeslam: " << files.samples << ": " << problem << "\n";
  }
  return samples;
}

std::vector<InertialSample> inertiaBeside(const FrameSource& source, const MeasuredUse& use,
                                          Configuration& configuration) {
  InertiaConfiguration& configured = configuration.inertia;
  configured.is_used |= use.imu;
  const InertialFiles files = source.inertialFiles();
  if (!configured.is_used) {
    if (!files.samples.empty()) std::cerr << "edgeslam: " << files.samples << " is not used; --imu uses it\n";
    return {};
  }
  if (const Recording* recording = source.recording()) {
    const std::vector<InertiaGiven>& given = recording->decisions.inertia;
    if (use.imu && given.empty()) throw InputError(recording->folder + ": the run was recorded without inertial data");
    return recorded(*recording, given, &InertiaGiven::sample, use.is_live);
  }
  if (configured.has_unit) return toldOf(files, readInertialSamples(files));
  InertialRecording beside = readInertialRecording(files);
  configured.unit = beside.unit;
  configured.has_unit = true;
  return toldOf(files, std::move(beside.samples));
}

// What is merely configured is used where it is there.
std::vector<OdometryPose> wheelsBeside(const FrameSource& source, const MeasuredUse& use,
                                       Configuration& configuration) {
  bool& is_used = configuration.settings.wheels.enabled;
  const std::string path = source.wheelOdometryPath();
  const Recording* recording = source.recording();
  const bool is_there = recording || !path.empty();
  is_used = use.wheels || (is_used && is_there);
  if (!is_used) {
    if (!path.empty()) std::cerr << "edgeslam: " << path << " is not used; --wheels uses it\n";
    return {};
  }
  if (recording) {
    const std::vector<WheelsGiven>& given = recording->decisions.wheels;
    if (use.wheels && given.empty()) {
      throw InputError(recording->folder + ": the run was recorded without wheel odometry");
    }
    return recorded(*recording, given, &WheelsGiven::pose, use.is_live);
  }
  if (path.empty()) throw InputError("--wheels: no wheel_odometry.txt lies beside the frames");
  return readWheelOdometry(path);
}

}  // namespace

MeasuredBeside measuredBeside(const FrameSource& source, const MeasuredUse& use, Configuration& configuration) {
  MeasuredBeside measured;
  measured.inertia = inertiaBeside(source, use, configuration);
  measured.wheels = wheelsBeside(source, use, configuration);
  configuration.settings = settingsWithSensors(configuration);
  return measured;
}

}  // namespace edgeslam
