// How long tracking a frame takes, beside a yardstick that travels with the machine: OpenCV's optical flow there and
// back over 550 points of the same frames in the same run. Usage: tracking_benchmark SEQUENCE_FOLDER [TRAJECTORY_FILE].
// One thread, lockstep. Times are the clock's, taken on the same thread by turns: on a busy machine both grow, and the
// ratio of the medians stays.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <map>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <string>
#include <vector>

#include "evaluation/trajectory.h"
#include "frames/frame_source.h"
#include "pipeline/lockstep_run.h"

namespace edgeslam {
namespace {

constexpr int yardstick_points = 550;

double milliseconds(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double, std::milli>(duration).count();
}

// Flow from one image to the next and back, as OpenCV does it by default; its points are chosen outside of the time.
class Yardstick {
 public:
  // [ms]; negative for the first image.
  double measure(const cv::Mat& grey) {
    double time = -1;
    if (!points_.empty() && last_.size() == grey.size()) {
      std::vector<cv::Point2f> there, back;
      std::vector<unsigned char> found;
      const auto start = std::chrono::steady_clock::now();
      cv::calcOpticalFlowPyrLK(last_, grey, points_, there, found, cv::noArray());
      cv::calcOpticalFlowPyrLK(grey, last_, there, back, found, cv::noArray());
      time = milliseconds(std::chrono::steady_clock::now() - start);
    }
    grey.copyTo(last_);
    cv::goodFeaturesToTrack(last_, points_, yardstick_points, 1e-4, 3);
    while (!points_.empty() && points_.size() < yardstick_points) points_.push_back(points_[points_.size() / 2]);
    return time;
  }

 private:
  cv::Mat last_;
  std::vector<cv::Point2f> points_;
};

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void printRow(const std::string& name, const std::vector<double>& times) {
  std::printf("%-17s %6zu frames  %6.2f / %6.2f\n", name.c_str(), times.size(), quantile(times, 0.5),
              quantile(times, 0.99));
}

int measure(const std::string& folder, const std::string& trajectory_file) {
  cv::setNumThreads(1);
  const std::unique_ptr<FrameSource> source = openFrames(folder);
  const std::optional<Camera> camera = source->camera();
  if (!camera) {
    std::cerr << folder << ": without a calibration\n";
    return 2;
  }
  LockstepRun run(*camera, Settings(), source->size(), /*drawings=*/0);
  Yardstick yardstick;
  std::vector<double> yardsticks, tracking;
  std::map<Stage, std::vector<double>> stages;
  while (const std::optional<Frame> frame = source->next()) {
    if (frame->grey.empty()) {
      run.skip(frame->index, frame->time_ns, frame->problem);
      continue;
    }
    const double flow = yardstick.measure(frame->grey);
    if (flow >= 0) yardsticks.push_back(flow);
    const StageTimes times = run.process(frame->index, frame->time_ns, frame->grey).times;
    double sum = 0;
    for (const Stage stage : all_stages) {
      if (!times.ran(stage)) continue;
      stages[stage].push_back(times[stage]);
      if (stage != Stage::mapping && stage != Stage::places) sum += times[stage];
    }
    tracking.push_back(sum);
  }
  const RunResult result = run.finish();
  std::printf("median / 99 in 100 [ms]\n");
  for (const auto& [stage, times] : stages) printRow(stageName(stage), times);
  printRow("tracking", tracking);
  printRow("yardstick", yardsticks);
  const double unit = quantile(yardsticks, 0.5), median = quantile(tracking, 0.5), most = quantile(tracking, 0.99);
  if (unit > 0 && median > 0) {
    std::printf("tracking in yardsticks: %.3f / %.3f; 99 in 100 over the median: %.2f\n", median / unit, most / unit,
                most / median);
  }
  if (trajectory_file.empty()) return 0;
  Trajectory trajectory;
  for (const FrameRecord& frame : result.frames) {
    if (frame.has_final_pose && frame.final_world == result.main_world)
      trajectory.push_back({frame.time_ns, frame.final_world_T_camera});
  }
  std::ofstream(trajectory_file) << formatTrajectory(trajectory);
  return 0;
}

}  // namespace
}  // namespace edgeslam

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    std::cerr << "usage: tracking_benchmark SEQUENCE_FOLDER [TRAJECTORY_FILE]\n";
    return 2;
  }
  try {
    return edgeslam::measure(argv[1], argc > 2 ? argv[2] : "");
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 2;
  }
}
