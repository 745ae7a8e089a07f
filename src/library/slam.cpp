#include "edgeslam/slam.h"

#include <limits>
#include <utility>

#include "library/conversion.h"
#include "map/saved_map.h"
#include "pipeline/lockstep_run.h"
#include "pipeline/map_records.h"

namespace edgeslam {

struct Slam::Work {
  explicit Work(const Configuration& configuration)
      : camera(*configuration.camera),
        needs_map(configuration.settings.tracking.map_is_frozen),
        run(camera, configuration.settings, 0, /*drawings=*/0) {}

  Camera camera;
  bool needs_map;  // before the first frame
  LockstepRun run;
  CameraOdometry odometry;
  std::int64_t frames = 0;
  std::int64_t last_time_ns = std::numeric_limits<std::int64_t>::min();
  std::size_t told_events = 0;
  std::vector<std::string> last_events;  // not told before finish()
  bool finished = false;

  void requireOpen() const {
    if (finished) throw InputError("no frame can follow after finish()");
    if (needs_map) throw InputError("map.frozen: there is no map to localise in; give one by goOnWith()");
  }
  PosedFrame latest() {
    ++frames;
    last_time_ns = run.latest().time_ns;
    return publicFrame(run.latest(), odometry.next(run.latest()));
  }
};

Slam::Slam(const std::string& configuration_file) : Slam("", configuration_file) {}

Slam::Slam(const std::string& calibration_file, const std::string& configuration_file)
    : work_(std::make_unique<Work>(libraryConfiguration(calibration_file, configuration_file))) {}

Slam::~Slam() = default;
Slam::Slam(Slam&&) noexcept = default;
Slam& Slam::operator=(Slam&&) noexcept = default;

int Slam::width() const { return work_->camera.width; }
int Slam::height() const { return work_->camera.height; }

void Slam::goOnWith(const std::string& map_file) {
  if (work_->frames > 0) throw InputError(map_file + ": a saved map can be continued before the first frame only");
  work_->run.goOnWith(loadMap(map_file, work_->camera));
  work_->needs_map = false;
}

void Slam::add(const InertialMeasurement& measurement) { work_->run.add(checkedSample(measurement)); }

void Slam::add(const WheelMeasurement& measurement) { work_->run.add(checkedPose(measurement)); }

PosedFrame Slam::process(const GreyImage& image, std::int64_t time_ns) {
  work_->requireOpen();
  const cv::Mat grey = checkedImage(image, work_->camera, time_ns, work_->last_time_ns);
  work_->run.process(work_->frames, time_ns, grey);
  return work_->latest();
}

PosedFrame Slam::skip(std::int64_t time_ns, const std::string& problem) {
  work_->requireOpen();
  requireLater(time_ns, work_->last_time_ns);
  work_->run.skip(work_->frames, time_ns, problem);
  return work_->latest();
}

std::vector<std::string> Slam::takeEvents() {
  if (work_->finished) return std::exchange(work_->last_events, {});
  const std::vector<std::string>& events = work_->run.events();
  const auto first = static_cast<std::ptrdiff_t>(std::exchange(work_->told_events, events.size()));
  return {events.begin() + first, events.end()};
}

std::vector<MapEdgePoint> Slam::map() const { return publicMap(work_->run.map(), work_->camera); }

std::vector<TimedCameraPose> Slam::keyframes() const {
  std::vector<TimedCameraPose> keyframes;
  for (const KeyframeRecord& record : keyframeRecords(work_->run.map())) {
    keyframes.push_back({record.time_ns, publicPose(record.world_T_camera), record.world});
  }
  return keyframes;
}

void Slam::saveMap(const std::string& map_file) const { saveLibraryMap(map_file, work_->camera, work_->run.map()); }

std::vector<TimedCameraPose> Slam::finish() {
  work_->requireOpen();
  work_->run.settle();
  work_->last_events = takeEvents();
  work_->finished = true;
  std::vector<TimedCameraPose> trajectory;
  for (const FrameRecord& frame : work_->run.finish().frames) {
    if (!frame.has_final_pose) continue;
    trajectory.push_back({frame.time_ns, publicPose(frame.final_world_T_camera), publicWorld(frame.final_world)});
  }
  return trajectory;
}

}  // namespace edgeslam
