#include "app/replay_outcome.h"

#include <algorithm>
#include <cstdio>

#include "edgeslam/input_error.h"
#include "evaluation/evaluation.h"
#include "report/report.h"
#include "report/run_summary.h"

namespace edgeslam {
namespace {

void tellFrames(const RunResult& result) {
  const auto& frames = result.frames;
  const double seconds =
      frames.empty() ? 0 : static_cast<double>(frames.back().time_ns - frames.front().time_ns) * 1e-9;
  std::printf("%zu frames (%.1f s) in %.1f s: %.2f x real time\n", frames.size(), seconds, result.wall_s,
              seconds / std::max(1e-9, result.wall_s));
  if (result.unreadable_frames > 0)
    std::printf("%lld frames could not be read and were skipped\n", static_cast<long long>(result.unreadable_frames));
  if (result.dropped_frames > 0)
    std::printf("%lld frames were dropped, newer ones being there\n", static_cast<long long>(result.dropped_frames));
}

void tellPoses(const RunResult& result, const RunSummary& summary) {
  if (summary.final_poses == 0) {
    std::printf("no pose: %s\n", result.frames.empty() ? "no frame" : result.frames.back().reason.c_str());
    return;
  }
  const WorldSummary& main = summary.worlds.front();
  std::printf("map started by %s\n", result.initialisation.c_str());
  std::printf("poses for %lld frames, %.1f %% from the first pose on; %lld keyframes, %lld map points, %lld lines\n",
              static_cast<long long>(summary.final_poses), 100.0 * summary.coverage,
              static_cast<long long>(main.keyframes), static_cast<long long>(main.map_points),
              static_cast<long long>(main.map_lines));
  if (summary.worlds.size() > 1) std::printf("%s\n", worldsInWords(summary.worlds).c_str());
  for (const std::string& event : result.events) std::printf("%s\n", event.c_str());
}

void tellCamera(const RunResult& result) {
  if (result.found.readout_s) {
    std::printf("found on the way: the camera reads its rows over %.1f ms (camera.readout: %.4f)\n",
                1e3 * *result.found.readout_s, *result.found.readout_s);
  }
  if (result.found.focal_scale != 1) {
    std::printf("found on the way: the focal length is not that of the calibration, but %.1f pixels\n",
                result.camera.fx);
  }
  if (result.found.principal_point != FoundCamera{}.principal_point) {
    std::printf("found on the way: the principal point is not that of the calibration, but cx: %.1f, cy: %.1f pixels\n",
                result.camera.cx, result.camera.cy);
  }
  if (result.found.radial != FoundCamera{}.radial) {
    std::printf("found on the way: the distortion is not that of the calibration, but k1: %.4f, k2: %.4f\n",
                result.camera.distortion[0], result.camera.distortion[1]);
  }
}

void tellInertia(const RunResult& result) {
  if (result.time_offset) {
    const double offset_s = 1e-9 * static_cast<double>(result.time_offset->offset_ns);
    std::printf("found on the way: the inertial unit's clock differs by %.1f ms +- %.1f (time_offset_s: %.4f)\n",
                1e3 * offset_s, 1e3 * result.time_offset->sigma_s, offset_s);
  }
  if (result.unit_rotation) {
    const Eigen::Quaterniond& q = result.unit_rotation->imu_R_camera;
    std::printf("found on the way: how the inertial unit is turned, +- %.2f degrees (imu_T_camera, ",
                degrees(result.unit_rotation->sigma_rad));
    std::printf("quaternion: [%.6f, %.6f, %.6f, %.6f])\n", q.w(), q.x(), q.y(), q.z());
  }
  const auto known = result.inertia.find(result.main_world);
  if (known != result.inertia.end()) {
    std::printf("lengths are metres (+- %.1f %%), and z is up, by inertia\n", 100 * known->second.scale_sigma);
  } else if (!result.lacking_for_inertia.empty()) {
    const bool is_metric = result.wheels.count(result.main_world) > 0;
    std::printf("%s: %s\n", is_metric ? "z is not up" : "lengths are map units", result.lacking_for_inertia.c_str());
  }
}

void tellWheels(const RunResult& result) {
  const auto known = result.wheels.find(result.main_world);
  if (known != result.wheels.end()) {
    std::printf("lengths are metres (+- %.1f %%), by the wheels\n", 100 * known->second.sigma);
  } else if (!result.lacking_for_wheels.empty()) {
    std::printf("lengths are map units: %s\n", result.lacking_for_wheels.c_str());
  }
  if (!result.contradiction_of_wheels.empty()) std::printf("%s\n", result.contradiction_of_wheels.c_str());
}

void tellError(const Trajectory& estimate, const Trajectory& ground_truth) {
  try {
    const AbsoluteError error = absoluteError(estimate, ground_truth, Alignment::similarity);
    std::printf("absolute trajectory error %.2f cm (RMSE of %d poses after similarity alignment)\n",
                100 * error.translation.rmse, error.pairs);
  } catch (const InputError& problem) {
    std::printf("no error figure: %s\n", problem.what());
  }
}

}  // namespace

void tellOutcome(const RunResult& result, const std::optional<Trajectory>& ground_truth, const std::string& output) {
  tellFrames(result);
  const RunSummary summary = summarise(result, std::nullopt);
  tellPoses(result, summary);
  tellCamera(result);
  if (summary.final_poses > 0) {
    tellInertia(result);
    tellWheels(result);
    if (ground_truth) tellError(finalTrajectory(result, result.main_world), *ground_truth);
    if (reportsAreBuiltIn()) {
      std::printf("%s/report.html shows it all\n", output.c_str());
    } else {
      std::printf("results are in %s; this build makes no report.html\n", output.c_str());
    }
  }
  if (!summary.recording_quality.empty()) std::printf("the recording: %s\n", summary.recording_quality.c_str());
}

}  // namespace edgeslam
