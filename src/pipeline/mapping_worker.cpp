#include "pipeline/mapping_worker.h"

#include "files/format_text.h"
#include "geometry/angles.h"

namespace edgeslam {
namespace {

// The images of keyframes that tracking does not compare with, a few at a time.
void packImages(const Map& map, const MapView& view) {
  constexpr int most = 8;
  int packed = 0;
  for (const Keyframe& keyframe : map.keyframes) {
    if (packed == most) return;
    const ViewKeyframe* shown = view.keyframes.find(keyframe.id);
    if (shown && shown->images) continue;
    packed += keyframe.images.pack() ? 1 : 0;
  }
}

}  // namespace

// The camera comes to a frozen map's places from anywhere, not from where the latest keyframe was.
MapperOptions MappingWorker::mapperOptions(const Settings& settings) {
  MapperOptions options = settings.mapping;
  options.view.nearest_sources = settings.tracking.map_is_frozen;
  return options;
}

void MappingWorker::goOnWith(Map map) {
  mapper_.goOnWith(std::move(map));
  updateRelocalisation();
}

void MappingWorker::updateRelocalisation() {
  relocalisation_.setCamera(mapper_.camera());
  relocalisation_.update(mapper_.map());
}

std::optional<MapUpdate> MappingWorker::handle(const MappingMessage& message) {
  last_message_ = message.number;
  last_frame_ = message.frame.frame_index;
  new_keyframe_ = false;
  found_.reset();
  not_found_.clear();
  if (message.frame.kind == FrameKind::lost) {
    find(message);
    return nextUpdate();
  }
  if (message.frame.kind == FrameKind::elsewhere) {
    mapper_.goBackTo(message.frame.keyframe);
    MapUpdate update = nextUpdate(message.frame.keyframe);
    packImages(mapper_.map(), update.view);
    return update;
  }
  const std::size_t worlds_given_up = mapper_.startsGivenUp();
  const bool was_initialised = mapper_.initialised(), was_metric = mapper_.knownAlignment() != nullptr,
             was_scaled = mapper_.knownWheelScale() != nullptr;
  const bool has_changed = mapper_.add(message.frame);
  if (mapper_.startsGivenUp() > worlds_given_up) first_valid_message_ = message.number;
  if (!has_changed) return std::nullopt;
  if (message.frame.kind == FrameKind::start && mapper_.initialised() && !was_initialised && mapper_.world() > 0) {
    report(last_frame_)
        .events.push_back("map " + std::to_string(mapper_.world()) +
                          " begins beside those before: " + mapper_.latestDescription());
  }
  if (const WheelScale* known = mapper_.knownWheelScale(); known && !was_scaled) {
    report(last_frame_)
        .events.push_back(formatted("the wheels tell metres: a map unit is %.3f m +- %.1f %%", known->metres_a_unit,
                                    100 * known->sigma));
  }
  if (const InertialAlignment* known = mapper_.knownAlignment(); known && !was_metric) {
    report(last_frame_)
        .events.push_back(formatted("the inertial unit tells metres and upright: a map unit is %.3f m +- %.1f %%",
                                    known->metres_a_unit, 100 * known->scale_sigma));
  }
  tellOfCamera();
  tellOfTimeOffset();
  tellOfUnitRotation();
  tellOfUnitLeftOut();
  if (const std::string lacking = lackingForMetres(); lacking != lacking_for_metres_) {
    report(last_frame_).lacking_for_metres = lacking_for_metres_ = lacking;
  }
  if (mapper_.initialised()) {
    new_keyframe_ = true;
    updateRelocalisation();
    std::vector<CulledKeyframe> culled = mapper_.takeCulled();
    if (!culled.empty()) report(last_frame_).culled = std::move(culled);
  }
  MapUpdate update = nextUpdate();
  if (new_keyframe_) packImages(mapper_.map(), update.view);
  return update;
}

// Once it has come to stay; what was told already is not told again.
void MappingWorker::tellOfCamera() {
  const FoundCamera& found = mapper_.map().found;
  const FoundCamera told = told_camera_;
  if (mapper_.cameraFinding().readoutIsSettled() && found.readout_s && found.readout_s != told.readout_s) {
    told_camera_.readout_s = found.readout_s;
    report(last_frame_)
        .events.push_back(formatted("the camera has a rolling shutter and reads its rows over %.1f ms: with "
                                    "camera.readout: %.4f in the configuration this is known from the start",
                                    1e3 * *found.readout_s, *found.readout_s));
  }
  if (!mapper_.cameraFinding().lensIsSettled()) return;
  const std::optional<double> told_readout_s = told_camera_.readout_s;
  told_camera_ = found;
  told_camera_.readout_s = told_readout_s;
  if (found.focal_scale != told.focal_scale) {
    report(last_frame_)
        .events.push_back(formatted("the focal length is not that of the calibration, but %.1f pixels: calibrate the "
                                    "camera",
                                    mapper_.camera().fx));
  }
  if (found.principal_point != told.principal_point) {
    report(last_frame_)
        .events.push_back(
            formatted("the principal point is not that of the calibration, but cx: %.1f, cy: %.1f pixels: "
                      "calibrate the camera",
                      mapper_.camera().cx, mapper_.camera().cy));
  }
  if (found.radial != told.radial) {
    report(last_frame_)
        .events.push_back(formatted("the distortion is not that of the calibration, but k1: %.4f, k2: %.4f: calibrate "
                                    "the camera",
                                    mapper_.camera().distortion[0], mapper_.camera().distortion[1]));
  }
}

void MappingWorker::tellOfTimeOffset() {
  constexpr std::int64_t worth_telling_ns = 1'000'000;
  const std::optional<FoundTimeOffset> found = mapper_.foundTimeOffset();
  if (!found || (told_offset_ns_ && std::abs(found->offset_ns - *told_offset_ns_) < worth_telling_ns)) return;
  told_offset_ns_ = found->offset_ns;
  const double offset_s = 1e-9 * static_cast<double>(found->offset_ns);
  MappingReport& told = report(last_frame_);
  told.is_of_setup = true;
  told.events.push_back(formatted(
      "the inertial unit's clock differs from the camera's by %.1f ms +- %.1f: with time_offset_s: %.4f beside "
      "imu_T_camera this is known from the start",
      1e3 * offset_s, 1e3 * found->sigma_s, offset_s));
}

void MappingWorker::tellOfUnitRotation() {
  constexpr double worth_telling = radians(0.3);
  const std::optional<FoundUnitRotation>& found = mapper_.foundUnitRotation();
  if (!found || (told_imu_R_camera_ && rotationAngle(found->imu_R_camera, *told_imu_R_camera_) < worth_telling)) return;
  told_imu_R_camera_ = found->imu_R_camera;
  const Eigen::Quaterniond& q = found->imu_R_camera;
  MappingReport& told = report(last_frame_);
  told.is_of_setup = true;
  told.events.push_back(formatted(
      "the inertial unit is turned by %.2f degrees +- %.2f against what imu_T_camera says: with quaternion: [%.6f, "
      "%.6f, %.6f, %.6f] there this is known from the start",
      degrees(rotationAngle(q, settings_.mapping.local_adjustment.inertia->imu_T_camera.rotation)),
      degrees(found->sigma_rad), q.w(), q.x(), q.y(), q.z()));
}

void MappingWorker::tellOfUnitLeftOut() {
  if (!mapper_.map().unit_is_left_out || std::exchange(told_left_out_, true)) return;
  MappingReport& told = report(last_frame_);
  told.is_of_setup = true;
  if (const LooseUnitCheck* loose = mapper_.looseUnit()) {
    told.events.push_back(
        formatted("the inertial unit moves against the camera in %.0f %% of the time, by up to %.1f degrees: is it "
                  "loose? The camera goes on alone",
                  100 * loose->share(), degrees(loose->largest())));
    return;
  }
  told.events.push_back(formatted(
      "the inertial unit seems to be turned by %.1f degrees against what imu_T_camera says: calibrate it; the "
      "camera goes on alone",
      degrees(mapper_.unitRotationTooFar())));
}

// Either will do; wheels know them sooner.
std::string MappingWorker::lackingForMetres() const {
  if (mapper_.knownAlignment() || mapper_.knownWheelScale()) return "";
  return settings_.mapping.local_adjustment.wheels ? mapper_.lackingForWheels() : mapper_.lackingForInertia();
}

// The frame's pose is lost: recovery by its tracks (P21), then the map as a whole (P22).
void MappingWorker::find(const MappingMessage& message) {
  const bool stands_meanwhile = message.starting && mapper_.initialised();
  if (mapper_.map().keyframes.empty() || stands_meanwhile) return;
  if (message.recover && recover(message)) return;
  if (settings_.relocalisation_enabled) relocalise(message);
}

bool MappingWorker::recover(const MappingMessage& message) {
  const RecoveryResult recovery = mapper_.recover(message.frame);
  not_found_ = recovery.reason;
  if (!recovery.found) return false;
  new_keyframe_ = true;
  updateRelocalisation();
  const Keyframe& keyframe = mapper_.map().keyframes.back();
  goOnFrom(TrackingState::recovered, keyframe.id, keyframe.world_T_camera, recovery.covariance, {},
           "recovered from three keyframes, " + std::to_string(recovery.inliers) + " points");
  reports_.back().culled = mapper_.takeCulled();
  return true;
}

void MappingWorker::relocalise(const MappingMessage& message) {
  const Map& map = mapper_.map();
  // What looks like a place out of reach is another place that looks the same.
  std::optional<Reachable> reachable;
  if (message.last_good_pose) {
    const WorldPose last = mapper_.inWorldOfToday({message.frame.world, *message.last_good_pose});
    reachable = reachableFrom(map, last.world_T_camera, message.seconds_since, last.world);
  }
  const RelocalisationResult result = relocalisation_.relocalise(map, *message.frame.images, *message.edges, reachable,
                                                                 message.frame.noise_factor, message.latest_believed);
  not_found_ = result.reason;
  if (!result.found) return;
  for (const Keyframe& keyframe : map.keyframes) keyframe.images.pack();  // the search is over
  mapper_.goBackTo(result.keyframe);
  std::vector<FoundAgain> points;
  for (const MatchedPoint& match : result.matches) points.push_back({match.point, match.measurement, match.corner});
  goOnFrom(TrackingState::relocalised, result.keyframe, result.world_T_camera, result.pose.covariance,
           std::move(points),
           "relocalised at keyframe " + std::to_string(result.keyframe) + ", " +
               std::to_string(result.evidence.inliers) + " of " + std::to_string(result.evidence.visible) + " points");
}

void MappingWorker::goOnFrom(TrackingState how, KeyframeId reference, const Pose& world_T_camera,
                             const Matrix6d& covariance, std::vector<FoundAgain> points, const std::string& event) {
  found_ = {last_frame_, how, world_T_camera, covariance, std::move(points)};
  found_reference_ = reference;
  found_reference_T_camera_ = mapper_.map().keyframes[reference].world_T_camera.inverse() * world_T_camera;
  MappingReport& done = report(last_frame_);
  done.events.push_back(event);
  done.found = {how, found_reference_, found_reference_T_camera_, mapper_.world()};
}

std::optional<MapUpdate> MappingWorker::apply(const Correction& correction) {
  if (correction.number < first_valid_message_) return std::nullopt;
  if (correction.found != mapper_.map().found) return std::nullopt;  // its rays are no longer those of the map
  if (!correction.events.empty() || correction.loop) {
    MappingReport& done = report(last_frame_);
    done.events = correction.events;
    done.loop = correction.loop;
    done.join = correction.change.join;
  }
  if (correction.change.empty()) return std::nullopt;
  mapper_.apply(correction.change);
  if (found_) {
    found_->world_T_camera = mapper_.map().keyframes[found_reference_].world_T_camera * found_reference_T_camera_;
  }
  return nextUpdate();
}

std::optional<Snapshot> MappingWorker::snapshot() const {
  if (!new_keyframe_) return std::nullopt;
  return Snapshot{last_message_, last_frame_, std::make_shared<const Map>(mapper_.map())};
}

std::optional<Snapshot> MappingWorker::mapInPlace() const {
  if (!new_keyframe_) return std::nullopt;
  const std::shared_ptr<const Map> not_owned(std::shared_ptr<const Map>(), &mapper_.map());
  return Snapshot{last_message_, last_frame_, not_owned};
}

MapUpdate MappingWorker::nextUpdate(KeyframeId centre) {
  MapUpdate update;
  update.number = next_update_++;
  update.answers = last_message_;
  update.view = mapper_.view(found_ ? found_reference_ : centre);
  update.found = found_;
  update.not_found = not_found_;
  return update;
}

MappingReport& MappingWorker::report(std::int64_t frame_index) {
  MappingReport& added = reports_.emplace_back();
  added.frame_index = frame_index;
  return added;
}

}  // namespace edgeslam
