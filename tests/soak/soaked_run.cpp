#include "soak/soaked_run.h"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

namespace edgeslam {
namespace {

constexpr std::size_t most_problems = 20;
constexpr std::size_t most_waiting_for_mapping = 2;
constexpr std::int64_t unreadable_each = 499;

bool isSound(const FrameResult& result) {
  if (!result.has_pose) return !isGoodPose(result.state);
  const double rotation = result.world_T_camera.rotation.norm();
  return result.world_T_camera.translation.allFinite() && std::abs(rotation - 1) < 1e-6 &&
         result.covariance.allFinite() && result.world_covariance.allFinite() &&
         result.world_covariance.diagonal().minCoeff() >= 0;
}

}  // namespace

SoakedRun::SoakedRun(const Camera& camera, SoakTotals& totals)
    : totals_(totals),
      camera_(camera),
      run_(camera, Settings(), LiveOptions(),
           {[this](const FrameResult& result, const std::string& problem) { receive(result, problem); }, {}, {}},
           nullptr) {}

void SoakedRun::begin(Map map) {
  if (!map.keyframes.empty()) run_.goOnWith(std::move(map));
  run_.start();
}

void SoakedRun::feed(const cv::Mat& grey, std::int64_t step_ns, const std::optional<Eigen::Vector3d>& truth) {
  FrameSlot& slot = run_.nextSlot();
  slot.index = handed_++;
  slot.time_ns = totals_.time_ns += step_ns;
  const bool is_unreadable = ++totals_.frames % unreadable_each == 0;
  slot.problem = is_unreadable ? "left out" : "";
  handed_unreadable_ += is_unreadable ? 1 : 0;
  totals_.unreadable += is_unreadable ? 1 : 0;
  grey.copyTo(slot.grey);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    expected_[slot.index] = {slot.time_ns, truth};
  }
  run_.handOver();
  const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (true) {
    const LiveCounts counts = run_.counts();
    if (counts.processed == handed_ && counts.messages_waiting <= most_waiting_for_mapping) return;
    if (std::chrono::steady_clock::now() > patience) return note("a frame took more than a minute");
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
}

Map SoakedRun::end() {
  run_.stop(/*settle=*/true);
  const LiveCounts counts = run_.counts();
  if (counts.captured != handed_) note("captured is " + std::to_string(counts.captured));
  if (counts.processed + counts.passed_over != handed_) note("frames are neither processed nor passed over");
  if (received_ + counts.not_published != counts.processed) note("results were lost and not counted");
  if (unreadable_ != handed_unreadable_) note("unreadable frames: " + std::to_string(unreadable_));
  if (counts.messages_waiting != 0 || counts.results_waiting != 0) note("something still waits after the end");
  const Map& map = run_.mapper().map();
  if (map.keyframes.size() != counts.keyframes || map.points.size() != counts.points) note("the map's counts differ");
  return map;
}

std::vector<double> SoakedRun::takeLatencies(std::int64_t& good_frames) {
  const std::lock_guard<std::mutex> lock(mutex_);
  good_frames = std::exchange(good_frames_, 0);
  std::vector<double> latencies = std::exchange(latencies_ms_, {});
  std::sort(latencies.begin(), latencies.end());
  return latencies;
}

void SoakedRun::receive(const FrameResult& result, const std::string& problem) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto expected = expected_.find(result.index);
  if (expected == expected_.end() || expected->second.time_ns != result.time_ns) note("a time stamp is another one");
  if (expected != expected_.end() && expected->second.truth && isGoodPose(result.state)) {
    judged_.push_back({result.world, result.world_T_camera, result.world_covariance, *expected->second.truth});
  }
  expected_.erase(expected_.begin(), expected_.upper_bound(result.index));
  if (result.index <= last_index_) note("a frame came twice or out of order");
  last_index_ = result.index;
  if (!isSound(result)) note("a pose that cannot be, frame " + std::to_string(result.index));
  ++received_;
  unreadable_ += problem.empty() ? 0 : 1;
  good_frames_ += isGoodPose(result.state) ? 1 : 0;
  latencies_ms_.push_back(result.latency_ms);
}

// From both threads, but never at the same time as it is read.
void SoakedRun::note(const std::string& problem) {
  if (totals_.problems.size() < most_problems) totals_.problems.push_back(problem);
}

}  // namespace edgeslam
