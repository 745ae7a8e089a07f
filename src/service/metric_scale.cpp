#include "service/metric_scale.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <optional>
#include <utility>

#include "files/format_text.h"

namespace edgeslam {
namespace {

std::string scaleText(const ScaleState& scale) {
  return formatted("the scale is %.6g metres a map unit, standard deviation %.2g %%", scale.metres_per_unit,
                   100 * scale.sigma);
}

// Numbers change each second.
std::string withoutDigits(std::string text) {
  text.erase(std::remove_if(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) || c == '.'; }),
             text.end());
  return text;
}

}  // namespace

MetricScale::MetricScale(const ScaleOptions& options, const Pose& body_T_camera, LcmPublisher& publisher,
                         BackgroundWork& work, EventLog& log)
    : options_(options),
      body_T_camera_(body_T_camera),
      publisher_(publisher),
      work_(work),
      log_(log),
      search_(options, body_T_camera) {}

void MetricScale::forget() {
  history_.clear();
  search_.forget();
  ground_keyframe_ = -1;
  told_problems_.clear();
  ++ground_looks_void_;
  if (isKnown()) log_.tell("the scale is unknown again: another map was begun");
  kind_ = ScaleKind::unknown;
  publisher_.setScale({});
}

void MetricScale::takeConfigured() {
  if (!(options_.metres_per_unit > 0)) return;
  kind_ = ScaleKind::known_distance;
  publisher_.setScale({kind_, options_.metres_per_unit, options_.sigma});
}

void MetricScale::mapWasCorrected() {
  history_.clear();
  search_.mapWasCorrected();
  ++ground_looks_void_;
}

void MetricScale::frame(const FrameResult& result) {
  history_.add(result);
  takeOdometry();
  search_.add(result);
}

void MetricScale::takeOdometry() {
  while (const std::optional<OdometryPose> pose = publisher_.nextOdometry()) search_.add(*pose);
}

CommandOutcome MetricScale::set(const Command& command) {
  const ScaleResult result =
      scaleFromDistance(history_, command.from_utime, command.to_utime, command.distance_m, options_);
  if (!result.problem.empty()) return {false, result.problem};
  kind_ = result.scale.kind;
  publisher_.setScale(result.scale);
  log_.tell(scaleText(result.scale));
  return {true, scaleText(result.scale)};
}

// What was set by command, or came with a saved map, stays until there is another map.
bool MetricScale::everySecond(double seconds, bool has_points) {
  const std::optional<ScaleState> found = search_.everySecond();
  if (kind_ == ScaleKind::known_distance) return false;
  if (found) take(*found);
  tellProblem();
  if (!search_.wantsMap(seconds) || !has_points) return false;
  search_.mapComes(seconds);
  ground_wanted_ = true;
  return true;
}

void MetricScale::take(const ScaleState& found) {
  if (!isKnown()) log_.tell(scaleText(found));
  kind_ = found.kind;
  publisher_.setScale(found);
}

std::string MetricScale::problem() const {
  if (kind_ == ScaleKind::known_distance) return "";
  const std::string problem = search_.problem();
  const std::int64_t ignored = publisher_.odometryIgnored();
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
  if (std::exchange(ground_keyframe_, latest) == latest) return;
  work_.begin([this, map, body_T_camera = body_T_camera_, height = options_.height,
               looks_void = ground_looks_void_]() -> BackgroundWork::Completion {
    const GroundPlane ground = groundOf(*map, body_T_camera, height);
    return [this, ground, looks_void] {
      if (looks_void == ground_looks_void_) search_.add(ground);
    };
  });
}

}  // namespace edgeslam
