// Hours' worth of frames, faster than real time, over changing sequences in one process:
//
//     soak --csv FILE [--passes N] [--hours H] SEQUENCE_FOLDER...
//
// A pass goes over each sequence three times (at its end the camera jumps back to its start, and has to be found
// again), each sequence in a run of its own as after a command RESET; every second pass goes on with the map that the
// pass before saved. It ends after N passes, or after H hours of the frames' time, or on Ctrl-C. Where a sequence has
// its truth (groundtruth.txt), the poses that were called good are held against it, and FILE.truth.csv tells how far
// they are off. Exit code 1 where something grew, was counted wrong, or is wrong; see soak_minutes.h and soak_truth.h
// for what that means.
#include <chrono>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <opencv2/core/utility.hpp>

#include "evaluation/trajectory.h"
#include "map/saved_map.h"
#include "recording/open_frame_source.h"
#include "soak/soak_minutes.h"
#include "soak/soak_truth.h"
#include "soak/soaked_run.h"

namespace edgeslam {
namespace {

constexpr int repeats = 3;
constexpr std::int64_t frames_a_minute = 1800;
constexpr std::int64_t jump_ns = 500'000'000;
constexpr std::int64_t same_time_ns = 10'000'000;  // of a frame and its truth

volatile std::sig_atomic_t interrupted = 0;

struct SoakArguments {
  std::string csv;
  std::int64_t passes = 1'000'000;
  double hours = 1'000'000;
  std::vector<std::string> sequences;
};

double processorSeconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Of sorted values.
double quantile(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return 0;
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

class Soak {
 public:
  explicit Soak(SoakArguments arguments)
      : arguments_(std::move(arguments)), csv_(arguments_.csv), truth_csv_(arguments_.csv + ".truth.csv") {
    if (!csv_ || !truth_csv_) throw InputError(arguments_.csv + ": cannot be written");
    csv_ << soakHeading();
    truth_csv_ << truthHeading();
  }

  int run() {
    for (pass_ = 0; pass_ < arguments_.passes && !isOver(); ++pass_) {
      for (const std::string& sequence : arguments_.sequences) {
        if (!isOver()) runOver(sequence);
      }
    }
    return judge();
  }

 private:
  bool isOver() const { return interrupted != 0 || static_cast<double>(totals_.time_ns) > arguments_.hours * 3600e9; }

  void runOver(const std::string& sequence) {
    const Camera camera = *openFrameSource(sequence)->camera();
    const std::string map_file = arguments_.csv + "." + nameOf(sequence) + ".map";
    SoakedRun run(camera, totals_);
    run.begin(pass_ % 2 == 1 && std::filesystem::exists(map_file) ? loadMap(map_file, camera) : Map());
    startMinute();
    for (int i = 0; i < repeats && !isOver(); ++i) {
      const std::unique_ptr<FrameSource> source = openFrameSource(sequence);
      const Trajectory truth = truthOf(*source);
      std::int64_t last_ns = -1;
      while (const std::optional<Frame> frame = source->next()) {
        if (interrupted != 0) break;
        if (!frame->problem.empty()) continue;
        run.feed(frame->grey, last_ns < 0 ? jump_ns : frame->time_ns - last_ns, truthAt(truth, frame->time_ns));
        last_ns = frame->time_ns;
        if (totals_.frames - minute_start_ >= frames_a_minute) endMinute(run, sequence);
      }
    }
    if (totals_.frames > minute_start_) endMinute(run, sequence);
    const Map map = run.end();
    if (!map.points.empty()) saveMap(map_file, camera, map);
    compareWithTruth(run.judged(), sequence);
  }

  static Trajectory truthOf(const FrameSource& source) {
    return source.groundTruthPath().empty() ? Trajectory() : readTrajectory(source.groundTruthPath());
  }

  static std::optional<Eigen::Vector3d> truthAt(const Trajectory& truth, std::int64_t time_ns) {
    const auto from = std::lower_bound(truth.begin(), truth.end(), time_ns - same_time_ns,
                                       [](const StampedPose& pose, std::int64_t time) { return pose.time_ns < time; });
    std::optional<Eigen::Vector3d> nearest;
    std::int64_t least_ns = same_time_ns;
    for (auto pose = from; pose != truth.end() && pose->time_ns <= time_ns + same_time_ns; ++pose) {
      const std::int64_t off_ns = std::abs(pose->time_ns - time_ns);
      if (off_ns > least_ns) continue;
      least_ns = off_ns;
      nearest = pose->world_T_camera.translation;
    }
    return nearest;
  }

  void compareWithTruth(const std::vector<JudgedPose>& poses, const std::string& sequence) {
    if (poses.empty() || interrupted != 0) return;
    SoakTruth truth = judgeByTruth(poses);
    truth.pass = pass_;
    truth.sequence = nameOf(sequence);
    truth_csv_ << truthLine(truth) << std::flush;
    truths_.push_back(truth);
  }

  static std::string nameOf(const std::string& sequence) {
    return std::filesystem::path(sequence).lexically_normal().filename().string();
  }

  void startMinute() {
    minute_start_ = totals_.frames;
    minute_processor_s_ = processorSeconds();
  }

  void endMinute(SoakedRun& run, const std::string& sequence) {
    const auto frames = static_cast<double>(totals_.frames - minute_start_);
    std::int64_t good_frames = 0;
    const std::vector<double> latencies = run.takeLatencies(good_frames);
    const LiveCounts counts = run.counts();
    SoakMinute minute;
    minute.pass = pass_;
    minute.sequence = nameOf(sequence);
    minute.frames = totals_.frames;
    minute.time_s = 1e-9 * static_cast<double>(totals_.time_ns);
    minute.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    minute.memory_mb = residentMegabytes();
    minute.processor_ms = 1e3 * (processorSeconds() - minute_processor_s_) / frames;
    minute.latency_50_ms = quantile(latencies, 0.5);
    minute.latency_90_ms = quantile(latencies, 0.9);
    minute.latency_99_ms = quantile(latencies, 0.99);
    minute.good_share = static_cast<double>(good_frames) / frames;
    minute.passed_over = counts.passed_over;
    minute.mapping_behind = counts.mapping_behind;
    minute.not_published = counts.not_published;
    minute.keyframes = counts.keyframes;
    minute.points = counts.points;
    csv_ << soakLine(minute) << std::flush;
    minutes_.push_back(minute);
    startMinute();
  }

  int judge() const {
    std::vector<std::string> problems = soakProblems(minutes_);
    for (const std::string& problem : truthProblems(truths_)) problems.push_back(problem);
    problems.insert(problems.end(), totals_.problems.begin(), totals_.problems.end());
    std::printf("%lld frames, %.2f h of them, %lld passes; %lld were told as unreadable\n",
                static_cast<long long>(totals_.frames), 1e-9 * static_cast<double>(totals_.time_ns) / 3600,
                static_cast<long long>(pass_), static_cast<long long>(totals_.unreadable));
    for (const std::string& problem : problems) std::printf("%s\n", problem.c_str());
    return problems.empty() ? 0 : 1;
  }

  SoakArguments arguments_;
  std::ofstream csv_, truth_csv_;
  SoakTotals totals_;
  std::vector<SoakMinute> minutes_;
  std::vector<SoakTruth> truths_;
  std::int64_t pass_ = 0, minute_start_ = 0;
  double minute_processor_s_ = 0;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

SoakArguments argumentsOf(int argc, char** argv) {
  SoakArguments arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto value = [&]() -> std::string {
      if (++i >= argc) throw InputError(word + ": a value is missing");
      return argv[i];
    };
    if (word == "--csv") {
      arguments.csv = value();
    } else if (word == "--passes") {
      arguments.passes = std::stoll(value());
    } else if (word == "--hours") {
      arguments.hours = std::stod(value());
    } else {
      arguments.sequences.push_back(word);
    }
  }
  if (arguments.csv.empty() || arguments.sequences.empty()) {
    throw InputError("usage: soak --csv FILE [--passes N] [--hours H] SEQUENCE_FOLDER...");
  }
  return arguments;
}

}  // namespace
}  // namespace edgeslam

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  std::signal(SIGINT, [](int) { edgeslam::interrupted = 1; });
  std::signal(SIGTERM, [](int) { edgeslam::interrupted = 1; });
  try {
    return edgeslam::Soak(edgeslam::argumentsOf(argc, argv)).run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "soak: %s\n", error.what());
    return 2;
  }
}
