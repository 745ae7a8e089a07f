// Map reuse (design, section 5): points that the map knows are projected into a frame whose pose is roughly known and
// found again across their edge by the patch of a keyframe that saw them. Also the guided search of relocalisation
// (P22).
#pragma once

#include <cstddef>
#include <memory_resource>
#include <vector>

#include "edges/edge_detection.h"
#include "geometry/camera.h"
#include "map/keyframe.h"

namespace edgeslam {

// A map point, and how a keyframe near in viewpoint saw it.
struct SearchPoint {
  PointId id = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // world
  const FrameImages* source_images = nullptr;          // of the keyframe; needed where the point is searched for
  Pose world_T_source;
  Eigen::Vector2f source_pixel = Eigen::Vector2f::Zero();
  Eigen::Vector2f source_normal = Eigen::Vector2f::UnitX();  // unit, from dark to bright
  bool corner = false;
  float sigma_normal = 0.5f;  // in the keyframe [px]
  float sigma_tangent = unknown_along;
  Twist source_twist = Twist::Zero();  // of the keyframe as its rows were read
};

using SearchPoints = std::pmr::vector<SearchPoint>;

struct MapSearchOptions {
  int window = 11;                 // side of the patch [px]
  int coarsest_level = 1;          // of the pyramid, where the search begins
  double radius = 6;               // searched across the edge; in both directions for a corner [px]
  int iterations = 8;              // most alignment steps a level
  double damping = 3;              // Levenberg term towards the start [grey^2/px^2]
  double least_correlation = 0.8;  // normalized cross-correlation with the keyframe's patch
  double largest_angle_deg = 45;   // between the rays from the keyframe and from the frame to the point
  double largest_scale = 2.5;      // of the patch, up or down
  double border = 8;               // projections nearer to the image's border are not searched [px]
  double edge_distance = 1.5;      // to an edge of the same direction [px]; a corner may be on any edge
  double edge_dot = 0.7;           // least dot product of the normals
};

// A point that should be in view.
struct VisiblePoint {
  std::size_t index = 0;                               // into the points
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();     // its projection [px]
  Eigen::Vector2f normal = Eigen::Vector2f::UnitX();   // its normal as seen from here: unit, from dark to bright
  Eigen::Matrix2f warp = Eigen::Matrix2f::Identity();  // takes offsets in the frame to offsets in the keyframe's image
};

using VisiblePoints = std::pmr::vector<VisiblePoint>;

struct FoundPoint {
  std::size_t index = 0;                              // into the points
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();    // [px]
  Eigen::Vector2f normal = Eigen::Vector2f::UnitX();  // unit, from dark to bright
  float correlation = 0;
};

using FoundPoints = std::pmr::vector<FoundPoint>;

// The points that project inside the image where it is not hidden, are seen from about the direction and the distance
// of their keyframe. Whether something stands before them is not known.
VisiblePoints visiblePoints(const Camera& camera, const SearchPoints& points, const MovingCamera& moving,
                            const MapSearchOptions& options,
                            std::pmr::memory_resource* memory = std::pmr::get_default_resource());

// Those of the visible points whose patch is found, on an edge of `edges`, in the order of `visible`. The pose that
// these are visible from may be wrong by what moves a point by the search radius in the image. What has no images is
// not found.
FoundPoints findVisiblePoints(const SearchPoints& points, const VisiblePoints& visible, const FrameImages& current,
                              const EdgeMap& edges, const MapSearchOptions& options,
                              std::pmr::memory_resource* memory = std::pmr::get_default_resource());

// What a found point measures: the accuracy that its keyframe's patch had, carried over.
Measurement measurementOf(const SearchPoint& point, const FoundPoint& found);

}  // namespace edgeslam
