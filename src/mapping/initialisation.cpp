#include "mapping/initialisation.h"

#include "mapping/initial_map.h"
#include "mapping/initial_rivals.h"
#include "mapping/initial_starts.h"

namespace edgeslam {

void Initialisation::start(const TrackedFrame& first) { start(InitialFrames{first, {}}); }

void Initialisation::start(InitialFrames frames) {
  frames_ = std::move(frames);
  const TrackedFrame& first = frames_.first;
  inverse_depths_.assign(first.observations.size(), 1.0);
  depth_sigmas_.assign(first.observations.size(), flat_start_sigma);
  accepted_ = InitialStructure();
  standing_camera_.forget();
  Pose first_T_camera;
  for (TrackedFrame& frame : frames_.since) {
    first_T_camera = locateAgainst(camera_, first, inverse_depths_, frame, first_T_camera).value_or(first_T_camera);
    frame.world_T_camera = first_T_camera;
  }
  waiting_for_ = "motion of the camera";
  changed_ = false;
}

bool Initialisation::add(const TrackedFrame& frame) {
  changed_ = false;
  addFrame(frames_, frame);
  if (!isDue()) return false;

  // P13: the first frame and this one are apart, and not because of a thing that moves.
  if (displacementLessRotation(camera_, frames_) < leastDisplacement(camera_, frames_, options_)) {
    waiting_for_ = "too little parallax: the points hardly moved, or by rotation only";
    return false;
  }
  if (standing_camera_.stands(camera_, frames_)) {
    waiting_for_ = standing_camera_.description();
    return false;
  }

  // P14: poses and points, adjusted together.
  std::optional<InitialStructure> structure =
      adjustInitialStructure(camera_, frames_, followedStart(frames_, inverse_depths_, options_), options_);
  if (!structure) {
    waiting_for_ = "the adjustment of the first frames failed";
    return false;
  }

  // P13 and P15: parallax, points and the quality factor.
  InitialEvidence evidence = judge(*structure);
  if (reasonToWait(evidence, options_).empty()) {
    structure = bestOfRivals(camera_, frames_, std::move(*structure), options_);
    evidence = judge(*structure);
  }
  goOnFrom(*structure);
  waiting_for_ = reasonToWait(evidence, options_);
  if (!waiting_for_.empty()) return false;
  description_ = describe(*structure, evidence);
  accepted_ = std::move(*structure);
  return true;
}

// Where the points fade soon there may be no other frame to try.
bool Initialisation::isDue() const {
  if (static_cast<int>(frames_.since.size()) < options_.fewest_frames) return false;
  const auto points = static_cast<double>(frames_.first.observations.size());
  const auto left = static_cast<double>(frames_.current().observations.size());
  if (left < options_.fading_share * points) return true;
  return frames_.since.size() % static_cast<std::size_t>(options_.attempt_interval) == 0;
}

InitialEvidence Initialisation::judge(const InitialStructure& structure) const {
  return judgeInitialStructure(frames_, structure, options_);
}

void Initialisation::goOnFrom(const InitialStructure& structure) {
  inverse_depths_ = structure.inverse_depths;
  depth_sigmas_ = structure.depth_sigmas;
  for (std::size_t i = 0; i < structure.frames.size(); ++i)
    frames_.since[structure.frames[i]].world_T_camera = structure.first_T_camera[i];
  changed_ = true;
}

std::string Initialisation::describe(const InitialStructure& structure, const InitialEvidence& evidence) const {
  return structure.method + " from frame " + std::to_string(frames_.first.frame_index) + " to frame " +
         std::to_string(frames_.current().frame_index) + ", " + inWords(evidence);
}

void Initialisation::writeProvisional(MapView& view) const {
  view = flatView(frames_.first);
  for (std::size_t i = 0; i < view.points.size(); ++i) {
    view.points[i].inverse_depth = inverse_depths_[i];
    view.points[i].inverse_depth_sigma = depth_sigmas_[i];
  }
}

Map Initialisation::map() const {
  Map begun = initialMap(camera_, frames_, accepted_, options_.largest_depth_sigma);
  if (camera_.readout_s == 0) tellMotion(frames_, earlyPoses(), begun);
  return begun;
}

std::optional<Pose> Initialisation::locate(const TrackedFrame& frame, const Pose& near) const {
  return locateAgainst(camera_, frames_.first, accepted_.inverse_depths, frame, near);
}

std::vector<std::pair<std::int64_t, Pose>> Initialisation::earlyPoses() const {
  return posesOfInitialFrames(camera_, frames_, accepted_);
}

}  // namespace edgeslam
