// Loop closing, section 3.5 of the paper, P23 to P27: is the new keyframe at a place seen before, and what follows.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "edges/image_reading.h"
#include "places/edge_signature.h"
#include "places/known_frame.h"
#include "places/loop_correction.h"
#include "places/loop_detection.h"
#include "places/loop_verification.h"

namespace edgeslam {

struct LoopClosingOptions {
  bool enabled = true;
  SignatureOptions signature;
  double thumbnail_weight =
      0.5;  // of the thumbnails' correlation in the score, the rest is the paper's; 0: the paper's alone
  int thumbnail_shift = 4;  // of thumbnails against each other [thumbnail px]
  LoopDetectionOptions detection;
  LoopVerificationOptions verification;
  LoopCorrectionOptions correction;
  double largest_turn_deg = 25;       // a loop that would turn the keyframe by more is no drift [deg]
  double largest_drift = 0.2;         // nor one that would move it by over this share of the way since ...
  double largest_view_turn_deg = 35;  // between two looks at one place that still look alike [deg]
  KnownFrameOptions known_frame;
  // Between worlds nothing is known beforehand, and where a camera errs more than a good one their shapes are rough:
  // where the search refuses what descriptors accept, so many other keyframes that say the same are enough ...
  double rough_noise_factor = 1.5;  // from which on that holds; below, shapes are exact, and places that look alike too
  int agreeing_keyframes = 2;
  int agreeing_near_keyframes = 3;  // ... and so many where the search finds nearly enough, and descriptors do not
  double agreeing_turn_deg = 5;     // [deg]
  double agreeing_distance = 0.15;  // share of the scene's distance
  double agreeing_scale = 0.15;     // of the scale's logarithm
  double largest_world_scale = 10;  // ... of the one unit in the other, or its inverse
  int telling_corners = 30;  // in agreement: no look-alike, even where the camera cannot have come there in that time
  int pause_keyframes = 5;   // after a loop no other one is looked for, for so many keyframes
  std::uint64_t seed = 1;
};

struct JudgedLoop {
  KeyframeId keyframe = -1;  // the candidate
  double score = 0;
  bool accepted = false;
  std::string reason;
  LoopVerification verification;
};

struct LoopOutcome {
  KeyframeId current = -1;
  double bar = 0;                      // P24
  std::vector<JudgedLoop> considered;  // best score first; the correction is from the accepted one with most inliers
  std::optional<LoopCorrection> correction;  // where one was accepted: for mapping to apply
};

// Accepted loops that put the current keyframe at different places (over 15 degrees or half of the scene's distance
// apart) are refused, all of them: the scene repeats itself, and none is to be trusted.
void refuseContradictions(const Map& map, KeyframeId current, std::vector<JudgedLoop>& loops);

class LoopClosing {
 public:
  // `reading`: of the images of keyframes.
  LoopClosing(const Camera& camera, const ImageReading& reading, const LoopClosingOptions& options)
      : camera_(camera), reading_(reading), options_(options) {}

  // It was found to be another one.
  void setCamera(const Camera& camera) { camera_ = camera; }

  // The map's latest keyframe, once for each, after the local adjustment. A map that was begun anew is told by the
  // frames of its keyframes. Verifies at most options.detection.most_candidates.
  LoopOutcome addKeyframe(const Map& map);

 private:
  struct Known {
    std::int64_t frame_index = -1;
    std::optional<EdgeSignature> signature;  // none without images
  };

  void describeNew(const Map& map);
  double score(const EdgeSignature& a, const EdgeSignature& b) const;
  bool withinDrift(const Map& map, KeyframeId current, KeyframeId earlier) const;
  double allowedMove(const Map& map, KeyframeId current, KeyframeId earlier) const;
  JudgedLoop judge(const Map& map, KeyframeId current, const LoopCandidate& candidate) const;
  void acceptAgreeingJoin(const Map& map, KeyframeId current, JudgedLoop& judged);
  void refuseWhereKnownOtherwise(const Map& map, KeyframeId current, JudgedLoop& judged) const;

  Camera camera_;
  ImageReading reading_;
  LoopClosingOptions options_;
  std::map<KeyframeId, Known> known_;
  KeyframeId last_loop_ = -1;  // keyframe at which the last loop was accepted
  // What keyframes said by their descriptors of how two worlds may be one, by keyframe.
  std::vector<std::pair<KeyframeId, WorldJoin>> proposed_joins_;
};

}  // namespace edgeslam
