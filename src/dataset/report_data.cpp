#include "dataset/report_data.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "dataset/report_map.h"
#include "dataset/report_published.h"

namespace edgeslam {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t most_samples = 4000;  // of a series over time: more than a screen has columns
constexpr std::size_t most_map_points = 250000;
constexpr std::size_t most_drawings = 24;
constexpr int widest_drawing = 800;  // [px]

// Rounds to a power of ten, dividing by its inverse where that is a whole number, so that decimals print short.
class Rounding {
 public:
  explicit Rounding(double step) {
    const double exponent = std::ceil(std::log10(std::max(step, 1e-12)) - 1e-9);
    unit_ = std::pow(10.0, std::abs(exponent));
    divides_ = exponent <= 0;
  }
  double step() const { return divides_ ? 1 / unit_ : unit_; }
  double steps(double value) const { return std::round(divides_ ? value * unit_ : value / unit_); }
  double operator()(double value) const { return divides_ ? steps(value) / unit_ : steps(value) * unit_; }

 private:
  double unit_ = 1;
  bool divides_ = true;
};

std::size_t strideFor(std::size_t count, std::size_t most) {
  return std::max<std::size_t>(1, (count + most - 1) / most);
}

class Clock {
 public:
  explicit Clock(const RunResult& result) : start_(result.frames.empty() ? 0 : result.frames.front().time_ns) {}
  double operator()(std::int64_t time_ns) const { return milliseconds_(1e-9 * static_cast<double>(time_ns - start_)); }

 private:
  std::int64_t start_;
  Rounding milliseconds_{1e-3};
};

void appendPosition(ordered_json& list, const Eigen::Vector3d& position, const Rounding& rounded) {
  for (int i = 0; i < 3; ++i) list.push_back(rounded(position[i]));
}

ordered_json trajectoryJson(const Trajectory& trajectory, const Similarity& display, const Clock& clock,
                            const Rounding& rounded) {
  ordered_json times = ordered_json::array();
  ordered_json positions = ordered_json::array();
  for (std::size_t i = 0; i < trajectory.size(); i += strideFor(trajectory.size(), most_samples)) {
    times.push_back(clock(trajectory[i].time_ns));
    appendPosition(positions, display * trajectory[i].world_T_camera.translation, rounded);
  }
  return {{"times", times}, {"positions", positions}};
}

// The ground truth from first to last frame, thinned.
Trajectory duringRun(const Trajectory& ground_truth, const RunResult& result) {
  Trajectory during;
  if (result.frames.empty()) return during;
  for (const StampedPose& pose : ground_truth) {
    if (pose.time_ns >= result.frames.front().time_ns && pose.time_ns <= result.frames.back().time_ns)
      during.push_back(pose);
  }
  return during;
}

ordered_json keyframesJson(const RunResult& result, const Similarity& display, const Clock& clock,
                           const Rounding& rounded) {
  const Rounding fine(1e-4);
  ordered_json keyframes = ordered_json::array();
  for (const KeyframeRecord& keyframe : result.keyframes) {
    const Eigen::Quaterniond rotation = display.rotation * keyframe.world_T_camera.rotation;
    ordered_json position = ordered_json::array();
    appendPosition(position, display * keyframe.world_T_camera.translation, rounded);
    keyframes.push_back({{"id", keyframe.id},
                         {"frame", keyframe.frame_index},
                         {"time", clock(keyframe.time_ns)},
                         {"position", position},
                         {"rotation", {fine(rotation.x()), fine(rotation.y()), fine(rotation.z()), fine(rotation.w())}},
                         {"reason", keyframe.reason}});
  }
  return keyframes;
}

// Numbers of the frames that begin a stretch of equal state, and of equal reason too where `by_reason`; at the end the
// number of frames.
std::vector<std::size_t> stretches(const RunResult& result, bool by_reason) {
  std::vector<std::size_t> begins;
  for (std::size_t i = 0; i < result.frames.size(); ++i) {
    const FrameRecord& frame = result.frames[i];
    const FrameRecord& before = result.frames[begins.empty() ? 0 : begins.back()];
    if (i == 0 || frame.state != before.state || frame.has_final_pose != before.has_final_pose ||
        (by_reason && frame.reason != before.reason)) {
      begins.push_back(i);
    }
  }
  begins.push_back(result.frames.size());
  return begins;
}

// Reasons that change with every frame of a long run are given only where they begin.
ordered_json stateRunsJson(const RunResult& result, const Clock& clock) {
  std::vector<std::size_t> begins = stretches(result, true);
  if (begins.size() > most_samples) begins = stretches(result, false);
  ordered_json runs = ordered_json::array();
  for (std::size_t i = 0; i + 1 < begins.size(); ++i) {
    const FrameRecord& first = result.frames[begins[i]];
    const FrameRecord& after = result.frames[std::min(begins[i + 1], result.frames.size() - 1)];
    runs.push_back({{"from", clock(first.time_ns)},
                    {"to", clock(after.time_ns)},
                    {"state", stateName(first.state)},
                    {"reason", first.reason},
                    {"final_pose", first.has_final_pose},
                    {"first_frame", first.index},
                    {"frames", begins[i + 1] - begins[i]}});
  }
  return runs;
}

ordered_json framesJson(const RunResult& result, const Clock& clock) {
  ordered_json times = ordered_json::array();
  ordered_json tracked = ordered_json::array();
  ordered_json mapped = ordered_json::array();
  for (std::size_t i = 0; i < result.frames.size(); i += strideFor(result.frames.size(), most_samples)) {
    times.push_back(clock(result.frames[i].time_ns));
    tracked.push_back(result.frames[i].tracked_points);
    mapped.push_back(result.frames[i].mapped_points);
  }
  return {{"times", times}, {"tracked", tracked}, {"mapped", mapped}};
}

bool ranAnywhere(const RunSummary& summary, Stage stage) {
  return std::any_of(summary.stages.begin(), summary.stages.end(),
                     [&](const StageSummary& ran) { return ran.name == stageName(stage); });
}

// Of each stage the mean over the frames that one column of the chart stands for.
ordered_json stageSeriesJson(const RunResult& result, const RunSummary& summary, const Clock& clock) {
  const Rounding fine(1e-2);
  const std::size_t stride = strideFor(result.frames.size(), most_samples / 2);
  ordered_json times = ordered_json::array();
  ordered_json names = ordered_json::array();
  ordered_json series = ordered_json::array();
  for (std::size_t i = 0; i < result.frames.size(); i += stride) times.push_back(clock(result.frames[i].time_ns));
  for (const Stage stage : all_stages) {
    if (!ranAnywhere(summary, stage)) continue;
    names.push_back(stageName(stage));
    ordered_json values = ordered_json::array();
    for (std::size_t i = 0; i < result.frames.size(); i += stride) {
      const std::size_t end = std::min(i + stride, result.frames.size());
      double sum = 0;
      for (std::size_t j = i; j < end; ++j) {
        sum += result.frames[j].times[stage];
      }
      values.push_back(fine(sum / static_cast<double>(end - i)));
    }
    series.push_back(std::move(values));
  }
  return {{"times", times}, {"names", names}, {"series", series}, {"frames_per_sample", stride}};
}

ordered_json errorSeriesJson(const std::optional<AbsoluteError>& error, const Clock& clock) {
  if (!error) return nullptr;
  const Rounding fine(1e-4);
  ordered_json times = ordered_json::array();
  ordered_json errors = ordered_json::array();
  for (std::size_t i = 0; i < error->errors.size(); i += strideFor(error->errors.size(), most_samples)) {
    times.push_back(clock(error->times_ns[i]));
    errors.push_back(fine(100 * error->errors[i]));
  }
  return {{"times", times}, {"errors_cm", errors}};
}

// Positions as whole numbers of `step`; `lines` gives the number of points of each line, in the order of the positions.
ordered_json mapJson(const RunResult& result, const Similarity& display, const Rounding& rounded) {
  std::vector<Eigen::Vector3d> cameras;
  for (const KeyframeRecord& keyframe : result.keyframes) cameras.push_back(keyframe.world_T_camera.translation);
  const std::vector<std::vector<int>> lines = joinChains(result.map_points, cameras);
  const std::size_t stride = strideFor(result.map_points.size(), most_map_points);
  constexpr double farthest = 1e9;  // steps: what is beyond would only bloat the page
  ordered_json positions = ordered_json::array();
  ordered_json lengths = ordered_json::array();
  ordered_json chains = ordered_json::array();
  ordered_json greys = ordered_json::array();
  ordered_json sigmas = ordered_json::array();
  std::size_t shown = 0;
  for (std::size_t line = 0; line < lines.size(); line += stride) {
    std::size_t length = 0;
    for (const int index : lines[line]) {
      const MapPointRecord& point = result.map_points[static_cast<std::size_t>(index)];
      const Eigen::Vector3d position = display * point.position / rounded.step();
      if (!(position.cwiseAbs().maxCoeff() < farthest)) continue;
      for (int i = 0; i < 3; ++i) positions.push_back(static_cast<std::int64_t>(std::lround(position[i])));
      greys.push_back(point.grey);
      const float sigma = std::isfinite(point.depth_sigma_ratio) ? point.depth_sigma_ratio : 1.0F;
      sigmas.push_back(std::lround(1000 * std::clamp(sigma, 0.0F, 1.0F)));
      ++length;
    }
    if (length == 0) continue;
    lengths.push_back(length);
    chains.push_back(result.map_points[static_cast<std::size_t>(lines[line].front())].chain);
    shown += length;
  }
  return {{"step", rounded.step()},
          {"positions", positions},
          {"lines", lengths},
          {"chains", chains},
          {"greys", greys},
          {"sigmas_permille", sigmas},
          {"points", result.map_points.size()},
          {"shown", shown}};
}

std::string base64(const std::vector<unsigned char>& bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    unsigned int group = 0;
    for (std::size_t j = 0; j < 3; ++j) group = (group << 8U) | (j < count ? bytes[i + j] : 0U);
    for (std::size_t j = 0; j < 4; ++j) text += j <= count ? digits[(group >> (18U - 6U * j)) & 63U] : '=';
  }
  return text;
}

ordered_json drawingsJson(const RunResult& result, const Clock& clock) {
  ordered_json drawings = ordered_json::array();
  for (std::size_t i = 0; i < result.drawings.size(); i += strideFor(result.drawings.size(), most_drawings)) {
    cv::Mat image = result.drawings[i].image;
    if (image.empty() || image.depth() != CV_8U) continue;
    if (image.cols > widest_drawing) {
      const double scale = static_cast<double>(widest_drawing) / image.cols;
      cv::resize(result.drawings[i].image, image, cv::Size(), scale, scale, cv::INTER_AREA);
    }
    std::vector<unsigned char> jpeg;
    if (!cv::imencode(".jpg", image, jpeg, {cv::IMWRITE_JPEG_QUALITY, 82})) continue;
    const std::int64_t index = result.drawings[i].index;
    ordered_json drawing = {{"frame", index},
                            {"width", image.cols},
                            {"height", image.rows},
                            {"image", "data:image/jpeg;base64," + base64(jpeg)}};
    const auto record = std::find_if(result.frames.begin(), result.frames.end(),
                                     [index](const FrameRecord& frame) { return frame.index == index; });
    if (record != result.frames.end()) {
      drawing["time"] = clock(record->time_ns);
      drawing["state"] = stateName(record->state);
      drawing["reason"] = record->reason;
      drawing["tracked"] = record->tracked_points;
      drawing["mapped"] = record->mapped_points;
      drawing["keyframe"] = record->is_keyframe;
    }
    drawings.push_back(std::move(drawing));
  }
  return drawings;
}

ordered_json publishedJson(const RunDescription& description) {
  std::optional<PublishedErrors> published = publishedErrors(description.sequence);
  if (!published) published = publishedErrors(description.input);
  if (!published) return nullptr;
  return {{"sequence", published->sequence},
          {"errors_cm",
           {{"Edge SLAM (paper)", published->edge_slam},
            {"ORB-SLAM", published->orb_slam},
            {"LSD-SLAM", published->lsd_slam},
            {"Edge VO", published->edge_vo},
            {"PL-SLAM", published->pl_slam}}}};
}

// Length of the diagonal of the box around the camera's positions, in the display's unit.
double extent(const Trajectory& trajectory, const Similarity& display) {
  Eigen::AlignedBox3d box;
  for (const StampedPose& pose : trajectory) {
    if (pose.world_T_camera.translation.allFinite()) box.extend(display * pose.world_T_camera.translation);
  }
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

double medianFrameInterval(const RunResult& result) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < result.frames.size(); ++i) {
    intervals.push_back(1e-6 * static_cast<double>(result.frames[i].time_ns - result.frames[i - 1].time_ns));
  }
  if (intervals.empty()) return 0;
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return *middle;
}

}  // namespace

DisplayFrame displayFrame(const RunResult& result, const RunSummary& summary) {
  std::optional<Similarity> reference_T_world;
  if (summary.errors.trajectory) reference_T_world = summary.errors.trajectory->reference_T_estimate;
  return displayFrame(finalTrajectory(result), reference_T_world);
}

DisplayFrame displayFrame(const Trajectory& trajectory, const std::optional<Similarity>& reference_T_world) {
  DisplayFrame frame;
  Eigen::Matrix3d turn;  // rows: the display's axes
  if (!reference_T_world) {
    turn << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    frame.display_T_world.rotation = Eigen::Quaterniond(turn);
    return frame;
  }
  Eigen::Vector3d camera_up = Eigen::Vector3d::Zero();
  for (const StampedPose& pose : trajectory) {
    camera_up -= reference_T_world->rotation * (pose.world_T_camera.rotation * Eigen::Vector3d::UnitY());
  }
  camera_up.normalize();
  turn.setIdentity();
  frame.x_name = "x", frame.y_name = "y", frame.z_name = "z";
  if (camera_up.z() < 0.3 && camera_up.cwiseAbs().maxCoeff() > 0.8) {
    int axis = 0;
    camera_up.cwiseAbs().maxCoeff(&axis);
    const double sign = camera_up[axis] > 0 ? 1 : -1;
    const std::array<std::string, 3> names{"x", "y", "z"};
    const int right = axis == 0 ? 1 : 0;
    turn.setZero();
    turn(2, axis) = sign;
    turn(0, right) = 1;
    turn.row(1) = turn.row(2).cross(turn.row(0));
    int forward = 0;
    turn.row(1).cwiseAbs().maxCoeff(&forward);
    frame.x_name = names[static_cast<std::size_t>(right)];
    frame.y_name = (turn(1, forward) < 0 ? "-" : "") + names[static_cast<std::size_t>(forward)];
    frame.z_name = (sign < 0 ? "-" : "") + names[static_cast<std::size_t>(axis)];
  }
  frame.display_R_reference = Eigen::Quaterniond(turn);
  Similarity display_T_reference;
  display_T_reference.rotation = frame.display_R_reference;
  frame.display_T_world = display_T_reference * *reference_T_world;
  frame.aligned = true;
  return frame;
}

ordered_json reportData(const RunResult& result, const RunSummary& summary, const RunDescription& description,
                        const std::optional<Trajectory>& ground_truth) {
  const DisplayFrame frame = displayFrame(result, summary);
  const Similarity& display = frame.display_T_world;
  const Clock clock(result);
  const Trajectory trajectory = finalTrajectory(result);
  const double size = extent(trajectory, display);
  const Rounding rounded(size > 0 && std::isfinite(size) ? size * 1e-5 : 1e-4);

  ordered_json truth;
  if (frame.aligned && ground_truth) {
    Similarity display_T_reference;
    display_T_reference.rotation = frame.display_R_reference;
    truth = trajectoryJson(duringRun(*ground_truth, result), display_T_reference, clock, rounded);
  }
  const Camera& camera = result.camera;
  return {{"summary", summaryJson(summary, result, description)},
          {"published", publishedJson(description)},
          {"aligned", frame.aligned},
          {"unit", frame.aligned ? "m" : "map units"},
          {"axes", {frame.x_name, frame.y_name, frame.z_name}},
          {"camera",
           {{"width", camera.width},
            {"height", camera.height},
            {"fx", camera.fx},
            {"fy", camera.fy},
            {"cx", camera.cx},
            {"cy", camera.cy}}},
          {"trajectory", trajectoryJson(trajectory, display, clock, rounded)},
          {"live", trajectoryJson(liveTrajectory(result), display, clock, rounded)},
          {"truth", truth},
          {"keyframes", keyframesJson(result, display, clock, rounded)},
          {"map", mapJson(result, display, rounded)},
          {"states", stateRunsJson(result, clock)},
          {"frames", framesJson(result, clock)},
          {"stages", stageSeriesJson(result, summary, clock)},
          {"frame_interval_ms", Rounding(1e-2)(medianFrameInterval(result))},
          {"error", errorSeriesJson(summary.errors.trajectory, clock)},
          {"live_error", errorSeriesJson(summary.errors.live, clock)},
          {"drawings", drawingsJson(result, clock)}};
}

}  // namespace edgeslam
