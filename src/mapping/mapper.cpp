#include "mapping/mapper.h"

#include <algorithm>
#include <cmath>

#include "geometry/median.h"
#include "mapping/line_association.h"
#include "mapping/line_placement.h"
#include "mapping/links_anew.h"
#include "mapping/wheel_turn_check.h"

namespace edgeslam {
namespace {

constexpr const char* unit_is_loose = "inertia: the unit moves against the camera; is it loose?";
constexpr const char* unit_is_turned_otherwise =
    "inertia: the unit seems to be turned otherwise than imu_T_camera says; calibrate it";
constexpr std::int64_t little_offset_ns = 1'500'000;  // a change of the unit's clock that bends no map

// Of recovered points, at least one, from the keyframe that hosts them [map units].
double medianDistance(const std::vector<RecoveredPoint>& points) {
  std::vector<double> inverse_depths;
  for (const RecoveredPoint& point : points) inverse_depths.push_back(point.inverse_depth);
  return 1 / upperMedian(inverse_depths);
}

}  // namespace

void Mapper::goOnWith(Map map) {
  map_ = std::move(map);
  takeCamera(withFound(calibrated_, map_.found));
  first_description_ = description_ = "a saved map";
  renewUncertainty(camera_, options_.uncertainty, map_);
  initialised_ = true;
  world_ = map_.keyframes.back().world;
  next_world_ = worldsOf(map_).back() + 1;
  ++version_;
}

bool Mapper::add(const TrackedFrame& frame) {
  switch (frame.kind) {
    case FrameKind::first:
      start({frame, {}});
      return false;
    case FrameKind::start:
    case FrameKind::spare:
      return goOnStarting(frame);
    case FrameKind::keyframe:
      return addKeyframe(frame);
    case FrameKind::lost:
    case FrameKind::elsewhere:
      break;
  }
  return false;
}

void Mapper::start(InitialFrames frames) {
  makeRoomFor(frames.first.keyframe);
  initialised_ = start_stood_ = false;
  candidates_.clear();
  spare_.reset();
  origin_frame_ = frames.first.frame_index;
  initialisation_.start(std::move(frames));
}

void Mapper::keepForSpare(const TrackedFrame& frame) {
  if (frame.kind == FrameKind::spare) {
    spare_ = InitialFrames{frame, {}};
  } else if (spare_) {
    addFrame(*spare_, frame);
  }
}

bool Mapper::goOnStarting(const TrackedFrame& frame) {
  if (spare_ && frame.start == spare_->first.frame_index) start(*std::exchange(spare_, std::nullopt));
  keepForSpare(frame);
  if (initialised_) {  // it was on its way when the map came to stand, or when an older world was found again
    if (!start_stood_ || starts_.back().world != world_) return false;
    auto& poses = starts_.back().poses;
    const std::optional<Pose> pose = initialisation_.locate(frame, poses.back().second);
    if (pose) poses.emplace_back(frame.frame_index, *pose);
    return false;
  }
  const std::string waited_for = initialisation_.waitingFor();
  if (initialisation_.add(frame)) {
    stand();
  } else if (!initialisation_.changed() && initialisation_.waitingFor() == waited_for) {
    return false;
  }
  ++version_;
  return true;
}

void Mapper::stand() {
  initialised_ = start_stood_ = true;
  world_ = next_world_++;
  Map begun = initialisation_.map();
  renewUncertainty(camera_, options_.uncertainty, begun);
  starts_.push_back({world_, begun.keyframes.front().id, 1, initialisation_.earlyPoses()});
  for (Keyframe& keyframe : begun.keyframes) {
    keyframe.world = world_;
    map_.keyframes.push_back(std::move(keyframe));
  }
  map_.points.merge(begun.points);
  for (const KeyframeId keyframe : keyframesOf(map_, world_)) {
    associateLines(camera_, options_.local_adjustment.lines, keyframe, map_);
  }
  description_ = initialisation_.description();
  if (map_.keyframes.front().world == world_) first_description_ = description_;
}

// Tracking gives numbers that it has not seen: where they are taken, the latest start came to stand too late for it.
void Mapper::makeRoomFor(KeyframeId keyframe) {
  if (!start_stood_ || map_.keyframes.empty() || map_.keyframes.back().id < keyframe) return;
  forgetFrom(map_, std::min(keyframe, starts_.back().origin));
  next_world_ = starts_.back().world;
  starts_.pop_back();
  start_stood_ = false;
  ++starts_given_up_;
}

void Mapper::goBackTo(KeyframeId keyframe) {
  initialised_ = true;
  world_ = map_.keyframes[keyframe].world;
  candidates_.clear();
  spare_.reset();
  ++version_;
}

// What was tracked in a world that was joined to another meanwhile is there now.
WorldPose Mapper::inWorldOfToday(WorldPose pose) const {
  for (auto join = joins_.find(pose.world); join != joins_.end(); join = joins_.find(pose.world)) {
    const Similarity& move = join->second.to_S_from;
    pose = {join->second.to, moved(move, pose.world_T_camera), moved(move, pose.twist)};
  }
  return pose;
}

bool Mapper::addKeyframe(const TrackedFrame& frame) {
  spare_.reset();
  const auto [world, world_T_camera, twist] = inWorldOfToday({frame.world, frame.world_T_camera, frame.twist});
  if (!initialised_ || world_ != world) {
    makeRoomFor(frame.keyframe);
    const KeyframeId latest = latestKeyframeOf(map_, world);
    if (latest < 0) return false;  // the world is gone: there was no room for it
    goBackTo(latest);
  }
  Keyframe keyframe;
  keyframe.id = std::max(frame.keyframe, map_.keyframes.back().id + 1);
  keyframe.world = world;
  keyframe.frame_index = frame.frame_index;
  keyframe.time_ns = frame.time_ns;
  keyframe.world_T_camera = world_T_camera;
  keyframe.twist = twist;
  keyframe.observations = frame.observations;
  keyframe.straight_edges = frame.straight_edges;
  keyframe.images = frame.images;
  keyframe.reason = frame.reason;
  keyframe.wheels = frame.wheels;
  if (frame.inertia.from >= 0 && frame.inertia.from == latestKeyframeOf(map_, world)) keyframe.inertia = frame.inertia;
  map_.keyframes.push_back(std::move(keyframe));
  associate(map_, candidates_);
  addNewPoints(camera_, options_.new_points, map_, candidates_);
  associateLines(camera_, options_.local_adjustment.lines, map_.keyframes.back().id, map_);
  placeLines(camera_, options_.local_adjustment.lines, map_);
  adjustLocally(camera_, options_.local_adjustment, map_);
  findCamera();
  findTimeOffset(frame);
  findUnitRotation();
  checkUnit();
  alignToEarth();
  scaleByWheels();
  const std::vector<CulledKeyframe> culled = cullKeyframes(options_.culling, map_, candidates_);
  culled_.insert(culled_.end(), culled.begin(), culled.end());
  addUncertainty(camera_, options_.uncertainty, map_);
  ++version_;
  return true;
}

void Mapper::findCamera() {
  if (!camera_finding_.look(calibrated_, options_.global_adjustment, options_.local_adjustment, map_)) return;
  takeCamera(withFound(calibrated_, map_.found));
  renewUncertainty(camera_, options_.uncertainty, map_);
  ++corrections_;
}

void Mapper::takeCamera(const Camera& camera) {
  camera_ = camera;
  initialisation_.setCamera(camera);
}

// Told to tracking by the view. What comes too late to be of use with it stays as it is.
void Mapper::findTimeOffset(const TrackedFrame& keyframe) {
  if (!time_offset_finding_ || map_.unit_is_left_out) return;
  time_offset_finding_->add(keyframe.time_ns, keyframe.felt, keyframe.turns);
  const std::optional<FoundTimeOffset>& found = time_offset_finding_->found();
  if (!found || (!map_.time_offset && !time_offset_finding_->comesInTime())) return;
  InertialUnit unit = *options_.local_adjustment.inertia;
  const std::int64_t before_ns = map_.time_offset ? map_.time_offset->offset_ns : unit.offset_ns;
  unit.offset_ns = found->offset_ns;
  map_.time_offset = found;
  takeLinksAnew(unit, time_offset_finding_->samples(), map_);
  if (std::abs(found->offset_ns - before_ns) > little_offset_ns) alignAnew();
}

InertialUnit Mapper::unitAsFound() const {
  InertialUnit unit = turnedAsFound(*options_.local_adjustment.inertia, map_.unit_rotation);
  if (const std::optional<FoundTimeOffset>& offset = time_offset_finding_->found()) unit.offset_ns = offset->offset_ns;
  return unit;
}

// Likewise.
void Mapper::findUnitRotation() {
  if (!unit_rotation_finding_ || map_.unit_is_left_out) return;
  const bool is_another = unit_rotation_finding_->look(time_offset_finding_->frames(), time_offset_finding_->samples(),
                                                       unitAsFound().offset_ns);
  if (unit_rotation_finding_->tooFar() > 0) leaveUnitOut(unit_is_turned_otherwise, 0);
  if (!is_another) return;
  map_.unit_rotation = unit_rotation_finding_->found();
  const bool bends_map = unit_rotation_finding_->bendsMap();
  time_offset_finding_->setRotation(map_.unit_rotation->imu_R_camera, bends_map);
  if (bends_map) alignAnew();
}

void Mapper::checkUnit() {
  if (!loose_unit_check_ || map_.unit_is_left_out) return;
  const std::vector<PosedCamera>& frames = time_offset_finding_->frames();
  if (!loose_unit_check_->look(frames, time_offset_finding_->samples(), unitAsFound())) return;
  leaveUnitOut(unit_is_loose, frames.back().time_ns - LooseUnitCheck::looked_back_ns);
}

// The camera goes on alone. What the unit said of scale and gravity before it was wrong stays.
void Mapper::leaveUnitOut(const char* why, std::int64_t wrong_since_ns) {
  map_.unit_is_left_out = true;
  lacking_ = why;
  InertialAlignment& alignment = map_.inertia[world_];
  alignment.is_known = alignment.is_known && metric_since_ns_ < wrong_since_ns;
  adjustGlobally(camera_, options_.global_adjustment, options_.local_adjustment, map_);
  renewUncertainty(camera_, options_.uncertainty, map_);
  ++corrections_;
}

// Where links were far off, the map is adjusted by the right ones, and how it lies to the earth is found once more.
void Mapper::alignAnew() {
  adjustGlobally(camera_, options_.global_adjustment, options_.local_adjustment, map_);
  renewUncertainty(camera_, options_.uncertainty, map_);
  ++corrections_;
  InertialAlignment& alignment = map_.inertia[world_];
  const InertialAlignment before = alignment;
  alignment = {};
  alignToEarth();
  if (!before.is_known || alignment.is_known) return;
  alignment = before;
  alignment.scale_sigma = std::max(before.scale_sigma, options_.inertial_alignment.largest_scale_sigma);
  alignment.adjusted_scale_sigma = 1;
}

const InertialAlignment* Mapper::knownAlignment() const {
  const auto found = map_.inertia.find(world_);
  return found != map_.inertia.end() && found->second.is_known ? &found->second : nullptr;
}

// Scale, gravity and biases are found with the keyframes held, and then adjusted together with all of the world: what
// bends a map looks like another scale or bias to the one alone. Once they are known, they follow each keyframe, and
// now and then all is adjusted together again, until the scale is known well.
void Mapper::alignToEarth() {
  if (!options_.local_adjustment.inertia || map_.unit_is_left_out) return;
  InertialAlignment& alignment = map_.inertia[world_];
  const bool was_known = alignment.is_known;
  const WheelScale* const wheels = knownWheelScale();
  const InertialAlignmentEstimate estimate =
      estimateInertialAlignment(turnedAsFound(*options_.local_adjustment.inertia, map_.unit_rotation),
                                options_.inertial_alignment, map_, world_, alignment, wheels ? *wheels : WheelScale());
  lacking_ = estimate.lacking;
  if (was_known) {
    // Of a saved map the gyroscope's bias is found before the others.
    if (estimate.lacking.empty() || !alignment.is_bias_known) alignment = estimate.alignment;
    const bool is_due = ++keyframes_since_alignment_ >= options_.alignment_interval;
    if (is_due && alignment.adjusted_scale_sigma > options_.well_known_scale_sigma) alignWithMap(alignment);
    return;
  }
  alignment = estimate.alignment;
  alignment.is_known = alignment.is_bias_known = false;
  if (estimate.lacking.empty()) alignWithMap(estimate.alignment);
  if (estimate.rough) alignWithMap(*estimate.rough);
}

// On a copy: what bends the map to no end is not kept.
void Mapper::alignWithMap(const InertialAlignment& start) {
  keyframes_since_alignment_ = 0;
  Map aligned = map_;
  InertialAlignment& alignment = aligned.inertia[world_];
  alignment = start;
  LocalAdjustmentOptions local = options_.local_adjustment;
  local.inertia_is_free = true;
  if (!adjustGlobally(camera_, options_.global_adjustment, local, aligned)) return;
  if (!(alignment.scale_sigma < options_.inertial_alignment.largest_scale_sigma)) {
    if (!start.is_known) lacking_ = speed_changes_too_little;
    return;
  }
  if (!map_.inertia[world_].is_known) metric_since_ns_ = map_.keyframes.back().time_ns;
  alignment.is_known = alignment.is_bias_known = true;
  lacking_.clear();
  map_ = std::move(aligned);
}

const WheelScale* Mapper::knownWheelScale() const {
  const auto found = map_.wheels.find(world_);
  return found != map_.wheels.end() && found->second.is_known ? &found->second : nullptr;
}

std::string Mapper::contradictionOfWheels() const {
  const std::optional<WheelOptions>& wheels = options_.local_adjustment.wheels;
  return wheels ? turnContradiction(*wheels, map_, world_) : "";
}

// Once it is known, the whole world is adjusted by it. From then on the map follows it, not it the map, whose scale
// drifts; how far they are apart makes it less certain.
void Mapper::scaleByWheels() {
  if (!options_.local_adjustment.wheels) return;
  WheelScale& scale = map_.wheels[world_];
  const WheelScaleEstimate estimate =
      estimateWheelScale(*options_.local_adjustment.wheels, options_.wheel_scale, map_, world_);
  lacking_for_wheels_ = scale.is_known ? "" : estimate.lacking;
  if (!estimate.scale.is_known) return;
  if (scale.is_known) {
    scale.sigma = std::hypot(estimate.scale.sigma, std::log(estimate.scale.metres_a_unit / scale.metres_a_unit));
    return;
  }
  scale = estimate.scale;
  adjustGlobally(camera_, options_.global_adjustment, options_.local_adjustment, map_);
}

RecoveryResult Mapper::recover(const TrackedFrame& lost) {
  RecoveryResult result;
  const KeyframeId last_id = initialised_ ? latestKeyframeOf(map_, world_) : -1;
  const KeyframeId before = last_id >= 0 ? keyframeBefore(map_, last_id) : -1;
  if (!options_.recovery_enabled || before < 0) {
    result.reason = "no map to go on from";
    return result;
  }
  const Keyframe& last = map_.keyframes[last_id];
  result = recoverTrackLoss(camera_, map_.keyframes[before], last, lost, options_.recovery);
  if (!result.found) return result;
  const double scene = sceneDistance(map_, last, options_.new_points.fewest_of_scene);
  if (medianDistance(result.points) < options_.new_points.least_distance * scene) {
    result.found = false;
    result.reason = "what was tracked seems far nearer than the scene: it moves";
    return result;
  }
  TrackedFrame found = lost;
  leaveOutContradictions(camera_, map_, result, options_.recovery.largest_miss, found.observations);
  for (const RecoveredPoint& recovered : result.points) {
    MapPoint point;
    point.id = recovered.id;
    point.host = last.id;
    point.host_bearing = recovered.host_bearing;
    point.inverse_depth = recovered.inverse_depth;
    point.inverse_depth_sigma = recovered.inverse_depth_sigma;
    point.corner = recovered.corner;
    point.chain_keyframe = last.id;
    point.chain = recovered.chain;
    point.order = recovered.order;
    map_.points.emplace(point.id, std::move(point));  // what is mapped already keeps its place
    candidates_.erase(recovered.id);
  }
  found.world = world_;
  found.world_T_camera = result.world_T_camera;
  found.reason = "recovery";
  addKeyframe(found);
  return result;
}

void Mapper::apply(const MapChange& change) {
  applyChange(change, map_);
  if (change.join) {
    joins_[change.join->from] = *change.join;
    for (Start& start : starts_) {
      if (start.world != change.join->from) continue;
      start.world = change.join->to;
      start.scale *= change.join->to_S_from.scale;
    }
    if (world_ == change.join->from) world_ = change.join->to;
  }
  renewUncertainty(camera_, options_.uncertainty, map_);
  ++corrections_;
  ++version_;
}

MapView Mapper::view(KeyframeId centre) const {
  MapView view;
  if (initialised_) {
    view = viewOfMap(map_, centre >= 0 ? centre : latestKeyframeOf(map_, world_), options_.view);
    view.latest_keyframe = map_.keyframes.back().id;
  } else {
    initialisation_.writeProvisional(view);
    view.waiting_for = initialisation_.waitingFor();
  }
  view.initialised = initialised_;
  view.found = map_.found;
  view.time_offset = map_.time_offset;
  view.unit_rotation = map_.unit_rotation;
  view.unit_is_left_out = map_.unit_is_left_out;
  view.version = version_;
  view.corrections = corrections_;
  view.origin_frame = origin_frame_;
  reserveForTracking(view);
  return view;
}

std::vector<EarlyPose> Mapper::earlyPoses() const {
  std::vector<EarlyPose> poses;
  for (const Start& start : starts_) {
    const Keyframe* origin = map_.keyframes.find(start.origin);
    if (!origin) continue;
    for (const auto& [frame, origin_T_camera] : start.poses) {
      const Pose scaled{origin_T_camera.rotation, start.scale * origin_T_camera.translation};
      poses.push_back({frame, origin->world, origin->world_T_camera * scaled});
    }
  }
  return poses;
}

}  // namespace edgeslam
