#include "app/measured_beside.h"

#include <iostream>
#include <utility>

#include "frames/inertial_file.h"
#include "frames/wheel_file.h"
#include "recording/recording_source.h"

namespace edgeslam {
namespace {

std::vector<InertialSample> recordedInertia(const Recording& recording, bool is_live) {
  if (recording.decisions.inertia.empty()) {
    throw InputError(recording.folder + ": the run was recorded without inertial data");
  }
  std::vector<InertialSample> samples;
  const bool is_repeated = !is_live && recording.decisions.not_recorded == 0;
  if (is_repeated) return samples;
  for (const InertiaGiven& given : recording.decisions.inertia) samples.push_back(given.sample);
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
  std::vector<InertialSample> samples;
  if (const Recording* recording = source.recording()) {
    samples = recordedInertia(*recording, use.is_live);
  } else if (configured.has_unit) {
    samples = readInertialSamples(files);
  } else {
    InertialRecording beside = readInertialRecording(files);
    configured.unit = beside.unit;
    configured.has_unit = true;
    samples = std::move(beside.samples);
  }
  configuration.settings = settingsWithInertia(configuration);
  return samples;
}

std::vector<OdometryPose> wheelsBeside(const FrameSource& source, const MeasuredUse& use, bool with_inertia,
                                       Configuration& configuration) {
  const std::string path = source.wheelOdometryPath();
  const bool asked = use.wheels || configuration.settings.wheels.enabled;
  if (!asked || (!use.wheels && (with_inertia || use.is_live || path.empty()))) {
    if (!path.empty()) std::cerr << "edgeslam: " << path << " is not used; --wheels uses it\n";
    return {};
  }
  if (path.empty()) throw InputError("--wheels: no wheel_odometry.txt lies beside the frames");
  useWheels({configuration.body_T_camera, configuration.settings.wheels.planar}, configuration.settings);
  return readWheelOdometry(path);
}

}  // namespace

MeasuredBeside measuredBeside(const FrameSource& source, const MeasuredUse& use, Configuration& configuration) {
  if (use.wheels && use.is_live) {
    throw InputError("--wheels: not with --realtime, where the wheels are not used yet");
  }
  if (use.wheels && (use.imu || configuration.inertia.is_used)) {
    throw InputError("--wheels: not together with --imu (imu.enabled) yet; each of them tells metres by itself");
  }
  MeasuredBeside measured;
  measured.inertia = inertiaBeside(source, use, configuration);
  measured.wheels = wheelsBeside(source, use, configuration.inertia.is_used, configuration);
  return measured;
}

}  // namespace edgeslam
