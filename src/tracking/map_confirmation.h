// Whether the map bears out the poses that tracking finds in it: of the points that were mapped some time ago and
// should be in view, how many are seen where they should be? Few of them, and the pose may follow something that moves,
// or a part of the map that grew wrong. That many are hidden tells nothing, so a pose in doubt is not refused: how far
// it led from the last one that was borne out is no longer known, and it is looked for in the map as it was then.
#pragma once

#include <cstdint>
#include <optional>

#include "geometry/similarity.h"
#include "map/map.h"

namespace edgeslam {

struct MapConfirmationOptions {
  int fewest_expected = 60;   // points: of fewer the share says nothing
  double least_share = 0.15;  // of the points expected that must be confirmed ...
  // ... and where the pose before was in doubt, or proof is asked for. A few points by chance must not end the search
  // for a pose in doubt.
  double least_share_to_believe_again = 0.3;
};

// Of a frame. Points count that were hosted some keyframes ago.
struct PointsConfirmed {
  int expected = 0;   // should be in view
  int confirmed = 0;  // are followed and agree, or are found near where they should be
};

// The last pose that the map bore out, or did not speak against.
struct ConfirmedPose {
  Pose world_T_camera;
  std::int64_t time_ns = 0;
  KeyframeId keyframe = -1;  // the latest one then
};

class MapConfirmation {
 public:
  explicit MapConfirmation(const MapConfirmationOptions& options) : options_(options) {}

  // The camera was lost, and found again by its tracks, not in the map as a whole: what they are on may have moved.
  void askForProof() { is_unproven_ = true; }

  // A frame that the map's points were looked for in.
  void observe(const PointsConfirmed& points, const ConfirmedPose& pose);

  // The map changed beneath it.
  void move(const Similarity& new_world_S_old);
  void forget();

  // Empty where there is no doubt.
  const std::optional<ConfirmedPose>& lastBeforeDoubt() const { return before_doubt_; }
  const PointsConfirmed& points() const { return points_; }  // of the latest frame observed

  // What doubt adds to the variance of the position along each axis [map units^2].
  double positionVariance(const Pose& world_T_camera) const;

 private:
  MapConfirmationOptions options_;
  PointsConfirmed points_;
  std::optional<ConfirmedPose> confirmed_;
  std::optional<ConfirmedPose> before_doubt_;
  bool is_unproven_ = false;
};

}  // namespace edgeslam
