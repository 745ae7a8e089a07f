// Optical flow forward and backward, and what it is made of, beside OpenCV's, on one thread: the same points, starts,
// window and levels, on pictures between which the motion is known. Prints how exact each is, and the times. usage:
// flow_benchmark [--benchmark_...]
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <random>
#include <string>
#include <vector>

#include "bench/known_warp.h"
#include "bench/ratio_reporter.h"
#include "bench/timed_work.h"
#include "edges/edge_detection.h"
#include "edges/point_choice.h"
#include "flow/optical_flow.h"
#include "flow/warped_window.h"
#include "geometry/undistortion.h"

namespace edgeslam {
namespace {

const cv::Size kSize(640, 480);
constexpr double kWrong = 1;  // a point that is farther off than this was not followed but lost [px]
// Of a prediction in x and in y [px]: of the frames of real sequences half are better than 0.15 to 0.4 px, 9 of 10 than
// 0.4 to 1.2 px.
constexpr double prediction_error = 0.4;
constexpr double hardly_damped = 0.03;  // [grey^2/px^2]

struct FlowTask {
  std::string name;
  KnownWarp warp;
  PicturePair pictures;
  std::vector<ChosenPoint> points;
  std::vector<Eigen::Vector2f> starts;  // of the points in the second picture
  FlowOptions options;
  ImagePyramid from, to;
  std::vector<cv::Mat> opencv_from, opencv_to;  // with derivatives
};

// Where each point was found there; NaN where it was not.
using Found = std::vector<Eigen::Vector2d>;

const Eigen::Vector2d not_found = Eigen::Vector2d::Constant(std::nan(""));

void buildOpenCvPyramid(const cv::Mat& image, const FlowOptions& options, std::vector<cv::Mat>& pyramid) {
  cv::buildOpticalFlowPyramid(image, pyramid, {options.window, options.window}, options.levels - 1);
}

// What tracking knows beforehand: where each point is, about.
std::vector<Eigen::Vector2f> predict(const std::vector<ChosenPoint>& points, const KnownWarp& warp) {
  std::mt19937 random(11);
  std::normal_distribution<double> error(0, prediction_error);
  std::vector<Eigen::Vector2f> predictions;
  for (const ChosenPoint& point : points) {
    const Eigen::Vector2d there = warp.apply(point.pixel.cast<double>());
    predictions.emplace_back(there.x() + error(random), there.y() + error(random));
  }
  return predictions;
}

enum class Start { predicted, where_it_was };

std::shared_ptr<FlowTask> makeTask(const std::string& name, Picture picture, const KnownWarp& warp, Start start) {
  auto task = std::make_shared<FlowTask>();
  task->name = name;
  task->warp = warp;
  task->pictures = renderPair(picture, kSize, warp);
  // Farther from the border than they move, so that no window leaves the pictures.
  PointChoiceOptions choice;
  choice.border = 60;
  task->points = choosePoints(task->pictures.first, detectEdges(task->pictures.first, {}), {}, choice);
  if (start == Start::predicted) {
    task->starts = predict(task->points, warp);
  } else {
    for (const ChosenPoint& point : task->points) task->starts.push_back(point.pixel);
    task->options.damping = hardly_damped;  // towards where the points are known not to be
  }
  task->from = buildPyramid(task->pictures.first, task->options.levels);
  task->to = buildPyramid(task->pictures.second, task->options.levels);
  buildOpenCvPyramid(task->pictures.first, task->options, task->opencv_from);
  buildOpenCvPyramid(task->pictures.second, task->options, task->opencv_to);
  return task;
}

Found followOurs(const FlowTask& task) {
  Found found;
  found.reserve(task.points.size());
  for (std::size_t i = 0; i < task.points.size(); ++i) {
    const ChosenPoint& point = task.points[i];
    const FlowMatch match = followPoint(task.from, task.to, point.pixel, task.starts[i], task.options);
    const bool returns = match.found && backwardError(task.from, task.to, point.pixel, match.pixel, point.normal,
                                                      task.options) <= task.options.forward_backward;
    found.push_back(returns ? Eigen::Vector2d(match.pixel.cast<double>()) : not_found);
  }
  return found;
}

Found followOpenCv(const FlowTask& task, const cv::TermCriteria& criteria) {
  std::vector<cv::Point2f> start, there, back;
  for (const ChosenPoint& point : task.points) start.emplace_back(point.pixel.x(), point.pixel.y());
  for (const Eigen::Vector2f& pixel : task.starts) there.emplace_back(pixel.x(), pixel.y());
  std::vector<unsigned char> status, status_back;
  const cv::Size window(task.options.window, task.options.window);
  const int levels = task.options.levels - 1;
  cv::calcOpticalFlowPyrLK(task.opencv_from, task.opencv_to, start, there, status, cv::noArray(), window, levels,
                           criteria, cv::OPTFLOW_USE_INITIAL_FLOW);
  back = start;
  cv::calcOpticalFlowPyrLK(task.opencv_to, task.opencv_from, there, back, status_back, cv::noArray(), window, levels,
                           criteria, cv::OPTFLOW_USE_INITIAL_FLOW);
  Found found;
  found.reserve(start.size());
  for (std::size_t i = 0; i < start.size(); ++i) {
    const Eigen::Vector2f off(back[i].x - start[i].x, back[i].y - start[i].y);
    const bool returns = status[i] && status_back[i] &&
                         std::abs(task.points[i].normal.dot(off)) <= static_cast<float>(task.options.forward_backward);
    found.push_back(returns ? Eigen::Vector2d(there[i].x, there[i].y) : not_found);
  }
  return found;
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::nan("");
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// Tab-separated: of corner-like points by the distance from where they are, of points of an edge by that across it: how
// many percent are right, how many wrong, and of those right the median and the ninth decile [px].
void printAccuracy(const FlowTask& task, const char* who, const Found& found) {
  for (const bool corner : {true, false}) {
    std::vector<double> errors;
    int all = 0, wrong = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const ChosenPoint& point = task.points[i];
      if (point.corner != corner) continue;
      ++all;
      if (found[i].hasNaN()) continue;
      const Eigen::Vector2d error = found[i] - task.warp.apply(point.pixel.cast<double>());
      const double size =
          corner ? error.norm() : std::abs(error.dot(task.warp.normalThere(point.normal.cast<double>())));
      if (size > kWrong) ++wrong;
      if (size <= kWrong) errors.push_back(size);
    }
    if (all < 20) continue;  // too few to tell
    std::printf("accuracy\t%s\t%s\t%d %s\t%.1f\t%.1f\t%.3f\t%.3f\n", task.name.c_str(), who, all,
                corner ? "corners" : "points of edges", 100.0 * static_cast<double>(errors.size()) / all,
                100.0 * wrong / all, quantile(errors, 0.5), quantile(errors, 0.9));
  }
}

void addTask(const std::shared_ptr<FlowTask>& task) {
  const cv::TermCriteria usual(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 30, 0.01);
  const cv::TermCriteria as_ours(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, task->options.iterations,
                                 AlignmentOptions().convergence);
  printAccuracy(*task, "ours", followOurs(*task));
  printAccuracy(*task, "OpenCV", followOpenCv(*task, usual));
  printAccuracy(*task, "OpenCV, our criteria", followOpenCv(*task, as_ours));
  const std::string kernel = "flow " + task->name;
  addTimed(kernel + "/ours", [=] { benchmark::DoNotOptimize(followOurs(*task)); });
  addTimed(kernel + "/calcOpticalFlowPyrLK", [=] { benchmark::DoNotOptimize(followOpenCv(*task, usual)); });
  addTimed(kernel + "/calcOpticalFlowPyrLK, our criteria",
           [=] { benchmark::DoNotOptimize(followOpenCv(*task, as_ours)); });
}

// A patch looked at in the way of flow: sampled from one picture, and compared with a place in the other.
void addPatches(const FlowTask& task) {
  constexpr int side = 15;
  const cv::Mat from = task.from.levels[0], to = task.to.levels[0];
  const auto step = static_cast<std::ptrdiff_t>(from.step[0]);
  const std::uint8_t* corner = from.ptr(200) + 300;
  const std::uint8_t* other = to.ptr(202) + 303;
  const BilinearWeights weights = bilinearWeights(0.3f, 0.6f);
  auto window = std::make_shared<SampledWindow>();
  auto patch = std::make_shared<PatchSamples>();
  constexpr std::size_t read = (side + 3) * (side + 3), kept = 3 * side * side * sizeof(std::int16_t);
  addTimed("patch made/ours", [=] {
    sampleWindow(corner, step, weights, side, *window);
    benchmark::DoNotOptimize(makePatchSamples(*window, side, *patch));
  });
  addTimed("patch made/reference", [=] {
    sampleWindowReference(corner, step, weights, side, *window);
    benchmark::DoNotOptimize(makePatchSamplesReference(*window, side, *patch));
  });
  addCopy("patch made", read + kept);
  addTimed("patch compared/ours", [=] { benchmark::DoNotOptimize(comparePatch(*patch, other, step, weights)); });
  addTimed("patch compared/reference",
           [=] { benchmark::DoNotOptimize(comparePatchReference(*patch, other, step, weights)); });
  struct Compared {
    cv::Mat window, patch, correlation;
  };
  auto compared = std::make_shared<Compared>();
  cv::getRectSubPix(from, {side, side}, {307.3f, 207.6f}, compared->patch);
  addTimed("patch compared/getRectSubPix, matchTemplate", [=] {
    cv::getRectSubPix(to, {side, side}, {310.3f, 209.6f}, compared->window);
    cv::matchTemplate(compared->window, compared->patch, compared->correlation, cv::TM_CCOEFF_NORMED);
  });
  addCopy("patch compared", (side + 1) * (side + 1) + kept);

  WarpedGrid grid;
  grid.x = 310 << 16;
  grid.y = 210 << 16;
  grid.x_by_row = 5000;
  grid.y_by_column = -4000;
  const std::uint8_t* origin = to.data;
  addTimed("patch warped/ours", [=] { sampleWarpedWindow(origin, step, grid, side, *window); });
  addTimed("patch warped/reference", [=] { sampleWarpedWindowReference(origin, step, grid, side, *window); });
  const cv::Mat affine = (cv::Mat_<double>(2, 3) << 1, 5000.0 / 65536, 301, -4000.0 / 65536, 1, 202);
  addTimed("patch warped/warpAffine", [=] {
    cv::warpAffine(to, compared->window, affine, {side + 2, side + 2}, cv::INTER_LINEAR | cv::WARP_INVERSE_MAP);
  });
  addCopy("patch warped", read + (side + 2) * (side + 2) * sizeof(std::int16_t));
}

// Both models, for the points of a frame.
void addUndistortion(const FlowTask& task) {
  const Camera pinhole{CameraModel::pinhole_radial_tangential, 640, 480, 517.3, 516.5, 318.6, 255.3,
                       {0.12, -0.22, -0.0022, 0.0012, 0}};
  const Camera fisheye{CameraModel::kannala_brandt,        640, 480, 285, 285, 318.6, 255.3,
                       {0.0034, 0.0007, -0.002, 0.0002, 0}};
  auto pixels = std::make_shared<std::vector<Eigen::Vector2d>>();
  auto points = std::make_shared<std::vector<cv::Point2d>>();
  for (const ChosenPoint& point : task.points) {
    pixels->push_back(point.pixel.cast<double>());
    points->emplace_back(point.pixel.x(), point.pixel.y());
  }
  for (const Camera& camera : {pinhole, fisheye}) {
    const bool is_fisheye = camera.model == CameraModel::kannala_brandt;
    const std::string kernel = is_fisheye ? "undistortion, fisheye" : "undistortion, pinhole";
    auto bearings = std::make_shared<std::vector<Eigen::Vector3d>>(pixels->size());
    addTimed(kernel + "/ours", [=] { bearingsOf(camera, pixels->data(), pixels->size(), bearings->data()); });
    addTimed(kernel + "/reference",
             [=] { bearingsReference(camera, pixels->data(), pixels->size(), bearings->data()); });
    const cv::Mat matrix = (cv::Mat_<double>(3, 3) << camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
    const cv::Mat distortion =
        cv::Mat(1, is_fisheye ? 4 : 5, CV_64F, const_cast<double*>(camera.distortion.data())).clone();
    auto undistorted = std::make_shared<std::vector<cv::Point2d>>();
    addTimed(kernel + "/undistortPoints", [=] {
      if (is_fisheye) {
        cv::fisheye::undistortPoints(*points, *undistorted, matrix, distortion);
      } else {
        cv::undistortPoints(*points, *undistorted, matrix, distortion);
      }
    });
    addCopy(kernel, pixels->size() * 5 * sizeof(double));
  }
}

}  // namespace
}  // namespace edgeslam

int main(int argument_count, char** arguments) {
  benchmark::Initialize(&argument_count, arguments);
  if (argument_count > 1) {
    std::fprintf(stderr, "usage: flow_benchmark [--benchmark_...]\n");
    return 2;
  }
  cv::setNumThreads(1);
  using edgeslam::Picture;
  using edgeslam::Start;
  const edgeslam::KnownWarp warp = edgeslam::turnAndShift(edgeslam::kSize, 2, 1.02, {5.4, 3.7});
  const auto textured = edgeslam::makeTask("texture", Picture::texture, warp, Start::predicted);
  edgeslam::addPatches(*textured);
  edgeslam::addUndistortion(*textured);
  edgeslam::addTask(textured);
  edgeslam::addTask(edgeslam::makeTask("edges", Picture::edges_only, warp, Start::predicted));
  edgeslam::addTask(edgeslam::makeTask("texture, unpredicted", Picture::texture, warp, Start::where_it_was));
  edgeslam::addTask(edgeslam::makeTask("edges, unpredicted", Picture::edges_only, warp, Start::where_it_was));
  edgeslam::RatioReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  return 0;
}
