// The start of the map (section 3.3 of the paper, P13 to P15, and design, section 5). A flat-depth start, whose poses
// tracking followed by edge normals, is adjusted over some ten frames. Before it is believed it must stand against
// rivals: the five-point algorithm where corners are many, and steady motions along the axes. The winner must have the
// parallax, the points and the quality factor asked for; cost alone never decides.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "map/map.h"
#include "map/map_view.h"
#include "mapping/initial_frames.h"
#include "mapping/initial_judgement.h"
#include "mapping/initial_structure.h"
#include "mapping/initialisation_options.h"
#include "mapping/standing_camera.h"

namespace edgeslam {

class Initialisation {
 public:
  Initialisation(const Camera& camera, const InitialisationOptions& options) : camera_(camera), options_(options) {}

  // Forgets what was.
  void start(const TrackedFrame& first);
  // Starts from these frames, most of which were followed against another first one.
  void start(InitialFrames frames);
  // For frames to come: it was found to be another one.
  void setCamera(const Camera& camera) { camera_ = camera; }

  // A frame after the first one. True where the map now stands; then `map()` has it.
  bool add(const TrackedFrame& frame);

  // What is missing, in words; empty once the map stands.
  const std::string& waitingFor() const { return waiting_for_; }
  // How the map came to stand, in words.
  const std::string& description() const { return description_; }
  // The provisional depths, for tracking to go on with. `changed` since the last call of start or add.
  bool changed() const { return changed_; }
  void writeProvisional(MapView& view) const;

  // Once the map stands: it, with keyframe 0 as the world.
  Map map() const;
  // keyframe0_T_camera of a frame that saw the first frame's points, from a pose near it.
  std::optional<Pose> locate(const TrackedFrame& frame, const Pose& near) const;
  // Final poses of all frames before (frame index, keyframe0_T_camera).
  std::vector<std::pair<std::int64_t, Pose>> earlyPoses() const;

 private:
  bool isDue() const;
  InitialEvidence judge(const InitialStructure& structure) const;
  void goOnFrom(const InitialStructure& structure);
  std::string describe(const InitialStructure& structure, const InitialEvidence& evidence) const;

  Camera camera_;
  InitialisationOptions options_;
  InitialFrames frames_;
  StandingCamera standing_camera_;
  std::vector<double> inverse_depths_, depth_sigmas_;  // provisional, of the first frame's points
  InitialStructure accepted_;
  std::string waiting_for_ = "no frame yet";
  std::string description_;
  bool changed_ = false;
};

}  // namespace edgeslam
