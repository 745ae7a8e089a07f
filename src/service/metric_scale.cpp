#include "service/metric_scale.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "files/format_text.h"
#include "pipeline/map_records.h"

namespace edgeslam {
namespace {

constexpr double largest_tilt = 0.017;  // of what is published as up [rad]

std::string scaleText(const ScaleState& scale) {
  return formatted("the scale is %.6g metres a map unit, standard deviation %.2g %%", scale.metres_per_unit,
                   100 * scale.sigma);
}

}  // namespace

MetricScale::MetricScale(const ScaleOptions& options, const Pose& body_T_camera, LcmPublisher& publisher,
                         BackgroundWork& work, EventLog& log)
    : options_(options), body_T_camera_(body_T_camera), publisher_(publisher), work_(work), log_(log) {
  worlds_.insert({no_world, WorldScale{ScaleSearch(options, body_T_camera), {}}});
}

// Nothing is known of it but what the wheels said last.
void MetricScale::begin(int world) {
  ScaleSearch search = here().search;
  search.forget();
  worlds_.insert_or_assign(world, WorldScale{std::move(search), {}});
}

void MetricScale::forgetWhatIsUnderWay() {
  ground_keyframe_ = -1;
  told_problems_.clear();
  ++ground_looks_void_;
}

void MetricScale::forget() {
  noMap();
  history_.clear();
  worlds_.erase(worlds_.upper_bound(no_world), worlds_.end());
}

void MetricScale::noMap() {
  if (isKnown()) log_.tell("the scale is unknown again: another map was begun");
  forgetWhatIsUnderWay();
  begin(no_world);
  world_ = no_world;
  publisher_.setScale({});
  publisher_.setDown({});
}

void MetricScale::beforeFrame(const FrameResult& result) {
  enterWorld(result);
  takeFromMap(result);
}

// A map that begins under a number known from before is another one.
void MetricScale::enterWorld(const FrameResult& result) {
  if (!measuredPose(result)) return;
  const int world = worldOf(result);
  if (world == world_) return;
  const bool is_another_map = world_ == no_world && result.state == TrackingState::tracking;
  if (is_another_map || worlds_.count(world) == 0) begin(world);
  const bool was_known = isKnown();
  world_ = world;
  here().search.breakOff();
  forgetWhatIsUnderWay();
  if (isKnown()) log_.tell(scaleText(here().scale));
  if (was_known && !isKnown()) log_.tell("the scale is unknown in this map");
  publisher_.setScale(here().scale);
  publisher_.setDown(here().down);
}

std::optional<MetricScale::MapScale> MetricScale::mapScale(const FrameResult& result) {
  if (result.inertia && result.inertia->is_known) {
    return MapScale{ScaleKind::inertia, result.inertia->metres_a_unit, result.inertia->scale_sigma};
  }
  if (!result.wheels.is_known) return std::nullopt;
  return MapScale{ScaleKind::odometry, result.wheels.metres_a_unit, result.wheels.sigma};
}

// The first time at once, with where up is: what is published changes once.
void MetricScale::takeFromMap(const FrameResult& result) {
  const std::optional<MapScale> told = mapScale(result);
  const bool knew = worldOf(result) == world_ && here().map && here().map->kind == ScaleKind::inertia;
  if (knew && result.inertia && !result.inertia->is_known) mapKnowsNoMore();
  if (!told || worldOf(result) != world_) return;
  WorldScale& world = here();
  world.map = told;
  if (result.inertia && result.inertia->is_known) takeDown(*result.inertia);
  if (world.by_map.scale().kind == ScaleKind::unknown) followMap();
}

// The map's metres turned out to be wrong: the inertial unit contradicts the camera.
void MetricScale::mapKnowsNoMore() {
  WorldScale& world = here();
  world.map.reset();
  if (world.scale.kind != ScaleKind::inertia) return;
  log_.tell("the scale is unknown again: the inertial unit contradicts the camera");
  begin(world_);
  publisher_.setScale(here().scale);
  publisher_.setDown({});
}

// Up stays, but where it was wrong.
void MetricScale::takeDown(const InertialAlignment& inertia) {
  WorldScale& world = here();
  const Eigen::Vector3d down = inertia.gravity.normalized();
  if (world.down && std::acos(std::min(1.0, down.dot(*world.down))) <= largest_tilt) return;
  world.down = down;
  publisher_.setDown(down);
}

// What was set by command, or came with a saved map, stays.
void MetricScale::followMap() {
  WorldScale& world = here();
  if (!world.map) return;
  world.by_map.follow({std::log(world.map->metres_a_unit), world.map->sigma, ""}, world.map->kind);
  if (world.scale.kind != ScaleKind::known_distance) take(world.by_map.scale());
}

// A saved map is the first world.
void MetricScale::takeConfigured() {
  if (!(options_.metres_per_unit > 0)) return;
  begin(0);
  world_ = 0;
  here().scale = {ScaleKind::known_distance, options_.metres_per_unit, options_.sigma};
  publisher_.setScale(here().scale);
}

void MetricScale::mapWasCorrected() {
  history_.clear();
  for (auto& [world, known] : worlds_) known.search.mapWasCorrected();
  ++ground_looks_void_;
}

void MetricScale::frame(const FrameResult& result) {
  beforeFrame(result);
  history_.add(result);
  takeOdometry();
  here().search.add(result);
}

void MetricScale::takeOdometry() {
  if (options_.source != "odometry") return;
  while (const std::optional<OdometryPose> pose = publisher_.nextOdometry()) here().search.add(*pose);
}

CommandOutcome MetricScale::set(const Command& command) {
  const ScaleResult result =
      scaleFromDistance(history_, command.from_utime, command.to_utime, command.distance_m, options_);
  if (!result.problem.empty()) return {false, result.problem};
  worlds_.at(result.world).scale = result.scale;
  publisher_.setScale(here().scale);
  const std::string text =
      scaleText(result.scale) + (result.world == world_ ? "" : ", in a map that the camera is not in now");
  log_.tell(text);
  return {true, text};
}

// What was set by command, or came with a saved map, stays until there is another map.
bool MetricScale::everySecond(double seconds, bool has_points) {
  ScaleSearch& search = here().search;
  const std::optional<ScaleState> found = search.everySecond();
  if (here().scale.kind == ScaleKind::known_distance) return false;
  followMap();
  if (found && !here().map) take(*found);
  tellProblem();
  if (!search.wantsMap(seconds) || !has_points) return false;
  search.mapComes(seconds);
  ground_wanted_ = true;
  return true;
}

void MetricScale::take(const ScaleState& found) {
  if (!isKnown()) log_.tell(scaleText(found));
  here().scale = found;
  publisher_.setScale(found);
}

std::string MetricScale::problem() const {
  if (here().scale.kind == ScaleKind::known_distance) return "";
  if (!map_lacks_.empty() && !isKnown()) return map_lacks_;
  const std::string problem = here().search.problem();
  const std::int64_t ignored = options_.source == "odometry" ? publisher_.odometryIgnored() : 0;
  if (problem.empty() || ignored == 0) return problem;
  return problem + " (" + std::to_string(ignored) + " messages of it were no pose of a body, or came too many at once)";
}

// Once of each kind for a map: problems come and go, and the status has them all.
void MetricScale::tellProblem() {
  const std::string told = problem();
  if (told.empty() || !told_problems_.insert(withoutDigits(told)).second) return;
  log_.tell((isKnown() ? "the scale is not renewed: " : "the scale is not known yet: ") + told);
}

void MetricScale::mapCame(const std::shared_ptr<const Map>& map) {
  if (!std::exchange(ground_wanted_, false) || map->keyframes.empty()) return;
  const KeyframeId latest = map->keyframes.back().id;
  if (keyframeRecords(*map, latest).front().world != world_) return;  // the ground is looked for around the latest
  if (std::exchange(ground_keyframe_, latest) == latest) return;
  work_.begin([this, map, body_T_camera = body_T_camera_, height = options_.height,
               looks_void = ground_looks_void_]() -> BackgroundWork::Completion {
    const GroundPlane ground = groundOf(*map, body_T_camera, height);
    return [this, ground, looks_void] {
      if (looks_void == ground_looks_void_) here().search.add(ground);
    };
  });
}

}  // namespace edgeslam
