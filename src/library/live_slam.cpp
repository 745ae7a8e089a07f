#include "edgeslam/live_slam.h"

#include <limits>
#include <utility>

#include "library/conversion.h"
#include "map/saved_map.h"
#include "pipeline/live_run.h"

namespace edgeslam {

struct LiveSlam::Work {
  Work(const Configuration& configuration, const std::string& map_file, PoseReceiver pose_receiver,
       EventReceiver event_receiver)
      : camera(*configuration.camera),
        poses(std::move(pose_receiver)),
        events(std::move(event_receiver)),
        run(camera, configuration.settings, liveOptions(configuration.settings.threads), observer(), nullptr) {
    if (!map_file.empty()) {
      run.goOnWith(loadMap(map_file, camera));
    } else if (configuration.settings.tracking.map_is_frozen) {
      throw InputError("map.frozen: there is no map to localise in; give one to the constructor");
    }
    run.start();
  }

  LiveObserver observer() {
    LiveObserver observer;
    observer.frame = [this](const FrameResult& result, const std::string&) {
      PosedFrame frame = publicFrame(result, odometry.next(result));
      frame.latency_ms = result.latency_ms;
      if (poses) poses(frame);
    };
    observer.report = [this](const MappingReport& report) {
      if (!events) return;
      for (const std::string& event : report.events) {
        events("frame " + std::to_string(report.frame_index) + ": " + event);
      }
    };
    return observer;
  }

  Camera camera;
  PoseReceiver poses;
  EventReceiver events;
  CameraOdometry odometry;  // the publishing thread's
  std::int64_t frames = 0;
  std::int64_t last_time_ns = std::numeric_limits<std::int64_t>::min();
  bool stopped = false;
  LiveRun run;
};

LiveSlam::LiveSlam(const std::string& configuration_file, PoseReceiver poses, EventReceiver events)
    : LiveSlam(configuration_file, "", std::move(poses), std::move(events)) {}

LiveSlam::LiveSlam(const std::string& configuration_file, const std::string& map_file, PoseReceiver poses,
                   EventReceiver events)
    : work_(std::make_unique<Work>(libraryConfiguration("", configuration_file), map_file, std::move(poses),
                                   std::move(events))) {}

LiveSlam::~LiveSlam() = default;

int LiveSlam::width() const { return work_->camera.width; }
int LiveSlam::height() const { return work_->camera.height; }

std::vector<std::string> LiveSlam::problems() const {
  std::vector<std::string> texts;
  for (const RefusedSetup& problem : work_->run.problems()) texts.push_back(problem.text);
  return texts;
}

void LiveSlam::handOver(const GreyImage& image, std::int64_t time_ns) {
  if (work_->stopped) throw InputError("no frame can follow after stop()");
  const cv::Mat grey = checkedImage(image, work_->camera, time_ns, work_->last_time_ns);
  FrameSlot& slot = work_->run.nextSlot();
  slot.index = work_->frames++;
  slot.time_ns = work_->last_time_ns = time_ns;
  slot.problem.clear();
  grey.copyTo(slot.grey);
  work_->run.handOver();
}

void LiveSlam::add(const InertialMeasurement& measurement) { work_->run.add(checkedSample(measurement)); }

void LiveSlam::add(const WheelMeasurement& measurement) { work_->run.add(checkedPose(measurement)); }

LiveCounters LiveSlam::counters() const {
  const LiveCounts counts = work_->run.counts();
  return {counts.captured, counts.processed, counts.passed_over, counts.keyframes, counts.points};
}

void LiveSlam::stop() {
  if (!std::exchange(work_->stopped, true)) work_->run.stop(/*settle=*/true);
}

std::vector<MapEdgePoint> LiveSlam::map() const {
  if (!work_->stopped) throw InputError("the map is to be had after stop()");
  return publicMap(work_->run.mapper().map(), work_->camera);
}

void LiveSlam::saveMap(const std::string& map_file) const {
  if (!work_->stopped) throw InputError(map_file + ": the map can be saved after stop()");
  saveLibraryMap(map_file, work_->camera, work_->run.mapper().map());
}

}  // namespace edgeslam
