// P22, second half: from a rough pose the map's points around a keyframe are projected into the frame and searched for,
// the pose is adjusted to what was found, and so on with a shrinking search. Accepted is only what the map explains as
// a whole: a wrong pose taken for good is worse than none.
#pragma once

#include <string>
#include <vector>

#include "adjustment/pose_adjustment.h"
#include "edges/edge_detection.h"
#include "edges/point_accuracy.h"
#include "map/map.h"
#include "places/explained_edges.h"
#include "tracking/map_search.h"

namespace edgeslam {

struct GuidedSearchOptions {
  MapSearchOptions search;  // of the last round; the first ones search farther
  PoseOptions pose;
  int screened_points = 120;     // searched for in the first round ...
  int searched_points = 300;     // ... and in each later one, at most
  double screening_radius = 20;  // [px]
  int neighbours = 6;            // covisible keyframes whose points are searched for too
  int fewest_inliers = 30;
  double inlier_share = 0.4;   // of the points that should be visible
  double corner_share = 0.25;  // likewise of the corners, where there are some ...
  int fewest_corners = 8;      // ... that is, so many
  // Fewer corners in agreement don't tell one place from another that looks alike; then more is asked:
  int telling_corners = 25;
  double bare_inlier_share = 0.75;
  double bare_corner_share = 0.5;
  double explained_share = 0.8;  // of the frame's edges that must be the map's
  // Where a place only looks alike, up to 20 corners agree. With clearly more of them fewer of the points in view are
  // enough: others are hidden by what has come into view since, or lie where the map is bent.
  int many_corners = 30;
  double many_corners_inlier_share = 0.25;
  double many_corners_share = 0.15;  // of the corners in view
  ExplainedEdgesOptions explained_edges;
  int fewest_cells = 5;           // of a grid of 4 x 4 over the image that inliers lie in
  double position_sigma = 0.02;   // largest standard deviation of the position, share of the points' median distance
  double rotation_sigma_deg = 1;  // and of the rotation
};

// A map point found in the frame.
struct MatchedPoint {
  PointId point = 0;
  Measurement measurement;
  bool corner = false;
  KeyframeId keyframe = -1;  // whose patch it was found by
};

// How much of what the map says about a pose the frame shows.
struct PoseEvidence {
  int visible = 0;          // map points that should be in view, of those searched for
  int inliers = 0;          // of these found and in agreement
  int visible_corners = 0;  // likewise the corners among them
  int corner_inliers = 0;
  int cells = 0;                  // of a grid of 4 x 4 over the image, that inliers lie in
  double position_sigma = 0;      // largest standard deviation of the position, share of the points' median distance
  double rotation_sigma_deg = 0;  // and of the rotation
  double median_distance = 0;     // of the points in agreement from the camera [map units]
  double explained = 0;           // share of the frame's edges that are the map's

  double share() const { return visible > 0 ? static_cast<double>(inliers) / visible : 0.0; }
};

struct GuidedSearchResult {
  bool accepted = false;
  std::string reason;  // why not
  PoseResult pose;
  PoseEvidence evidence;
  std::vector<MatchedPoint> inliers;
};

// The map points that a keyframe and its best covisible ones see, ascending.
std::vector<PointId> pointsAround(const Map& map, KeyframeId keyframe, int neighbours);

// The points with, of each, how the keyframe saw it that did so most nearly from where `world_T_camera` does, without
// its images. `sources` gets these keyframes, one a point.
SearchPoints searchPoints(const Map& map, const std::vector<PointId>& points, const Pose& world_T_camera,
                          std::vector<KeyframeId>& sources);

// A frame in which map points are searched for.
struct SearchedFrame {
  const FrameImages& images;
  const EdgeMap& edges;
  PointAccuracy accuracy;  // of what is measured in it
};

// A first look from a rough pose at some of the points: the pose adjusted to them and what speaks for it.
struct ScreenedPose {
  Pose world_T_camera;
  PoseEvidence evidence;  // counts only
};
ScreenedPose screenPose(const Camera& camera, const Map& map, const std::vector<PointId>& points,
                        const SearchedFrame& frame, const Pose& world_T_camera, const GuidedSearchOptions& options);

// Why a pose with this evidence is not to be trusted; empty where it is.
std::string reasonToRefuse(const PoseEvidence& evidence, const GuidedSearchOptions& options);

// From a screened pose to the final one, or the reason to refuse it.
GuidedSearchResult guidedSearch(const Camera& camera, const Map& map, const std::vector<PointId>& points,
                                const SearchedFrame& frame, const Pose& world_T_camera,
                                const GuidedSearchOptions& options);

}  // namespace edgeslam
