// The start of the map (section 3.3 of the paper, P13 to P15, and design, section 5). A flat-depth start, whose poses
// tracking followed by edge normals, is adjusted over some ten frames. Before it is believed it must stand against
// rivals: the five-point algorithm where corners are many, and steady motions along the axes. The winner must have the
// parallax, the points and the quality factor asked for; cost alone never decides.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "adjustment/bundle_adjustment.h"
#include "map/map.h"
#include "map/map_view.h"
#include "mapping/quality_factor.h"

namespace edgeslam {

struct InitialisationOptions {
  int frames_between = 8;             // frames adjusted between the first and the current one
  int attempt_interval = 5;           // frames from one attempt to the next
  double least_displacement_px = 3;   // median motion in the image, less what a rotation explains, to begin with [px]
  double least_parallax_deg = 1.0;    // median angle under which the points see the two cameras [deg]
  double prior_sigma = 0.5;           // of the inverse depth around 1
  double largest_depth_sigma = 0.15;  // a point counts where its depth's standard deviation is below this share
  int fewest_points = 100;            // points that must count ...
  double point_share = 0.4;           // ... or this share of those followed, where the scene has less
  double outlier = 3.0;               // whitened error of an observation
  int five_point_corners = 50;        // corner-like points from which on the five-point start is tried as well
  double least_quality = 0.6;         // share of the pieces that must hold (P15)
  QualityOptions quality;
  BundleOptions bundle{20, 2.0};
};

// A structure from the first frame to the current one.
struct InitialStructure {
  std::string method;               // "flat start" or "five-point"
  std::vector<std::size_t> frames;  // indices into the frames added since the start, ascending; the last is the current
  std::vector<Pose> first_T_camera;    // one for each of these
  std::vector<double> inverse_depths;  // one a point of the first frame; 0: none
  std::vector<double> depth_sigmas;
  QualityFactor quality;
  double parallax_deg = 0;
  int points = 0;    // that count
  int followed = 0;  // points seen in the current frame
  double error = 0;  // mean whitened squared error of all observations, each bounded by the outlier limit
  bool usable = false;
};

class Initialisation {
 public:
  Initialisation(const Camera& camera, const InitialisationOptions& options) : camera_(camera), options_(options) {}

  void start(const TrackedFrame& first);
  // True where the map now stands; then `map()` has it.
  bool add(const TrackedFrame& frame);

  const std::string& waitingFor() const { return waiting_for_; }
  const std::string& description() const { return description_; }
  // The provisional depths, for tracking to go on with. `changed` since the last call of start or add.
  bool changed() const { return changed_; }
  void writeProvisional(MapView& view) const;
  Map map() const;
  // keyframe0_T_camera of a frame that saw the first frame's points, once the map stands; from a pose near it.
  std::optional<Pose> locate(const TrackedFrame& frame, const Pose& near) const;
  // Final poses of all frames before the map stood (frame index, keyframe0_T_camera).
  std::vector<std::pair<std::int64_t, Pose>> earlyPoses() const;

 private:
  bool attempt();
  InitialStructure followedStart() const;
  InitialStructure fivePointStart() const;
  InitialStructure directionStart(const Eigen::Vector3d& direction, const char* name) const;
  std::vector<InitialStructure> rivals() const;
  double boundedError(const BundleProblem& adjusted, const std::vector<BundleObservation>& observations) const;
  InitialStructure adjust(InitialStructure structure) const;
  void judge(InitialStructure& structure) const;
  std::vector<std::size_t> chooseFrames() const;
  std::string reasonToWait(const InitialStructure& structure) const;
  double displacementLessRotation() const;

  Camera camera_;
  InitialisationOptions options_;
  TrackedFrame first_;
  std::vector<TrackedFrame> frames_;
  std::vector<double> inverse_depths_, depth_sigmas_;  // of the first frame's points
  InitialStructure accepted_;
  std::string waiting_for_ = "no frame yet";
  std::string description_;
  bool changed_ = false;
};

}  // namespace edgeslam
