// P22: where track-loss recovery fails, the camera is found again against the whole map: keyframes that look like the
// frame, a rough pose from each, a guided search from there. It looks for a place, as loop detection does, but
// mapping's thread does it: a lost robot does not wait behind an adjustment of the whole map.
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "edges/point_choice.h"
#include "places/guided_search.h"
#include "places/keyframe_matching.h"
#include "places/reach.h"
#include "places/thumbnail.h"

namespace edgeslam {

struct RelocalisationOptions {
  GuidedSearchOptions guided_search;
  KeyframeMatchingOptions matching;
  // Of the frame, to be matched with the keyframes': descriptors say little of points along an edge.
  PointSpread points{/*count=*/300, /*spacing=*/6, /*cell=*/40, /*corner_share=*/0.8};
  int described_points = 250;     // of a keyframe, corner-like ones first
  int candidates = 5;             // keyframes tried in one frame
  int matched_candidates = 2;     // of these, matched by descriptors too
  int refined_poses = 2;          // most poses of one kind that are followed up from a first look
  double screened_share = 0.25;   // of the points in view that must agree roughly at the first look
  double same_place_share = 0.3;  // keyframes that share so many of their points are one place ...
  int candidates_of_place = 2;    // ... of which so many are tried before others
  double rival_share =
      0.85;  // of the frame's edges that the best pose explains: another that explains as many rivals it
  double rival_distance = 0.05;    // poses farther apart are different: share of the points' median distance ...
  double rival_rotation_deg = 3;   // ... or this angle
  int compared_turned = 12;        // keyframes of which thumbnails are compared at turns too
  double least_correlation = 0.3;  // of the thumbnails, for a candidate
  int fewest_matches = 8;          // of descriptors, and of these in agreement, for a pose from them
  double descriptor_error = 5;     // reprojection error within which a match agrees [px]
  int ransac_iterations = 150;
};

struct RelocalisationResult {
  bool found = false;
  std::string reason;  // why not: of the keyframe that came nearest to it
  Pose world_T_camera;
  PoseResult pose;                    // covariance; inliers by match before outliers were taken out
  KeyframeId keyframe = -1;           // the candidate that led there
  std::vector<MatchedPoint> matches;  // the map points that agree with the pose
  PoseEvidence evidence;              // what spoke for the pose
};

// Keeps what relocalisation needs of each keyframe.
class Relocalisation {
 public:
  // `accuracy`: of points measured in frames.
  Relocalisation(const Camera& camera, const PointAccuracyOptions& accuracy, const RelocalisationOptions& options)
      : camera_(camera), accuracy_(accuracy), options_(options) {}

  // It was found to be another one.
  void setCamera(const Camera& camera) { camera_ = camera; }

  // A keyframe without images is passed over; one already known is taken anew.
  void addKeyframe(const Keyframe& keyframe);
  // The same for each keyframe of the map that is not known yet; those no longer in the map are forgotten.
  void update(const Map& map);

  // The pose of a frame of which nothing is known but, where given, what can be reached. Where things repeat and two
  // different poses are as good, there is none. `noise_factor`: how many times as far as presumed its measurements err.
  // It is compared with no keyframes after `latest`. `map`'s keyframes are those added, where they are now. Same input,
  // same result.
  RelocalisationResult relocalise(const Map& map, const FrameImages& current, const EdgeMap& edges,
                                  const std::optional<Reachable>& reachable = std::nullopt, double noise_factor = 1,
                                  KeyframeId latest = std::numeric_limits<KeyframeId>::max()) const;

 private:
  struct KnownKeyframe {
    std::int64_t frame_index = -1;
    Thumbnail thumbnail;
    std::vector<PointId> points;  // those described, in the order of `described.points`
    DescribedPoints described;
  };
  struct Candidate {
    KeyframeId keyframe = -1;
    ThumbnailMatch match;
  };
  struct Start {
    KeyframeId keyframe = -1;
    Pose world_T_camera;
  };

  std::vector<Candidate> candidates(const Map& map, const Thumbnail& thumbnail, KeyframeId latest) const;
  std::vector<Start> startsByTurning(const Map& map, const std::vector<Candidate>& candidates) const;
  std::vector<Start> startsByDescriptors(const Map& map, const std::vector<Candidate>& candidates,
                                         const SearchedFrame& frame) const;
  void searchFrom(const std::vector<Start>& starts, const Map& map, const SearchedFrame& frame,
                  const std::optional<Reachable>& reachable, RelocalisationResult& result) const;
  std::vector<Candidate> differentPlaces(const Map& map, const std::vector<Candidate>& ranked, int of_place,
                                         int wanted) const;
  std::optional<Pose> poseByDescriptors(const Map& map, KeyframeId keyframe, const DescribedPoints& frame) const;

  Camera camera_;
  PointAccuracyOptions accuracy_;
  RelocalisationOptions options_;
  std::map<KeyframeId, KnownKeyframe> keyframes_;
};

}  // namespace edgeslam
