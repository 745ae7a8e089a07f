// The metric scale: by command, or found by itself.
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <utility>

#include "service/run_publisher.h"

namespace edgeslam {
namespace {

std::string scaleText(const ScaleState& scale) {
  char text[120];
  std::snprintf(text, sizeof(text), "the scale is %.6g metres a map unit, standard deviation %.2g %%",
                scale.metres_per_unit, 100 * scale.sigma);
  return text;
}

// Numbers change each second.
std::string withoutDigits(std::string text) {
  text.erase(std::remove_if(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) || c == '.'; }),
             text.end());
  return text;
}

}  // namespace

// The scale was that of a map that is no more.
void RunPublisher::forgetScale() {
  history_.clear();
  search_.forget();
  ground_keyframe_ = -1;
  told_scale_problems_.clear();
  ++ground_looks_void_;
  if (scale_ != ScaleKind::unknown) log_.tell("the scale is unknown again: another map was begun");
  scale_ = ScaleKind::unknown;
  publisher_.setScale({});
}

// Positions before and after do not go together.
void RunPublisher::mapWasCorrected() {
  history_.clear();
  search_.mapWasCorrected();
  ++ground_looks_void_;
}

void RunPublisher::setScale(const Command& command) {
  const ScaleResult result =
      scaleFromDistance(history_, command.from_utime, command.to_utime, command.distance_m, setup_.scale);
  if (!result.problem.empty()) return answer(command, false, result.problem);
  scale_ = result.scale.kind;
  publisher_.setScale(result.scale);
  log_.tell(scaleText(result.scale));
  answer(command, true, scaleText(result.scale));
}

void RunPublisher::takeOdometry() {
  while (const std::optional<OdometryPose> pose = publisher_.nextOdometry()) search_.add(*pose);
}

// What was set by command, or came with a saved map, stays until there is another map.
void RunPublisher::followScale(Clock::time_point now) {
  const std::optional<ScaleState> found = search_.everySecond();
  if (scale_ == ScaleKind::known_distance || !run_) return;
  if (found) {
    if (scale_ == ScaleKind::unknown) log_.tell(scaleText(*found));
    scale_ = found->kind;
    publisher_.setScale(*found);
  }
  tellScaleProblem();
  const double seconds = std::chrono::duration<double>(now - start_).count();
  if (search_.wantsMap(seconds) && run_->counts().points > 0) {
    search_.mapComes(seconds);
    ground_wanted_ = true;
    run_->askForMap();
  }
}

std::string RunPublisher::scaleProblem() const {
  if (scale_ == ScaleKind::known_distance) return "";
  const std::string problem = search_.problem();
  const std::int64_t ignored = publisher_.odometryIgnored();
  if (problem.empty() || ignored == 0) return problem;
  return problem + " (" + std::to_string(ignored) + " messages of it were no pose of a body, or came too many at once)";
}

// Once of each kind for a map: problems come and go, and the status has them all.
void RunPublisher::tellScaleProblem() {
  const std::string problem = scaleProblem();
  if (problem.empty() || !told_scale_problems_.insert(withoutDigits(problem)).second) return;
  log_.tell((scale_ == ScaleKind::unknown ? "the scale is not known yet: " : "the scale is not renewed: ") + problem);
}

void RunPublisher::lookForGround(const MapPointer& map) {
  if (map->keyframes.empty() || std::exchange(ground_keyframe_, map->keyframes.back().id) == map->keyframes.back().id) {
    return;
  }
  work_.begin([this, map, looks_void = ground_looks_void_]() -> BackgroundWork::Completion {
    const GroundPlane ground = groundOf(*map, setup_.body_T_camera, setup_.scale.height);
    return [this, ground, looks_void] {
      if (looks_void == ground_looks_void_) search_.add(ground);
    };
  });
}

}  // namespace edgeslam
