// A bundle problem laid out for solving: only what takes part, the observations of a point or line side by side, and
// for every pair of free cameras that see one together the place of their block in the reduced system.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "adjustment/bundle_adjustment.h"
#include "adjustment/reprojection.h"

namespace edgeslam {

struct StructuredObservation {
  WhitenedPixel measured;
  int target = 0;   // camera
  int viewer = -1;  // which of the point's viewers the target is; -1: fixed
  int row = -1;     // of the structure's rows; -1: the target does not move while it is read
};

// Cameras that are free and bear on a point (its host and its targets) are its viewers.
struct StructuredPoint {
  Eigen::Vector3d host_bearing, host_origin;
  int index = 0;  // in the problem
  int host = 0;   // camera
  bool free = false;
  int host_viewer = -1;  // -1: fixed
  int first_observation = 0, end_observation = 0;
  int first_viewer = 0, end_viewer = 0;
  int first_block = 0;           // of the blocks of its pairs of viewers, see blockOfPair()
  double prior_information = 0;  // 1 / prior_sigma^2; 0: no prior
  double prior_inverse_depth = 0;
};

struct StructuredLineObservation {
  Eigen::Vector3d bearing;  // unit, camera frame of its row
  double sigma = 0;         // [rad]
  int target = 0;           // camera
  int viewer = -1;          // which of the line's viewers the target is; -1: fixed
  int row = -1;             // of the structure's rows; -1: the target does not move while it is read
};

// Cameras that are free and see a line are its viewers. It has no host.
struct StructuredLine {
  int index = 0;  // in the problem
  bool free = false;
  int first_observation = 0, end_observation = 0;  // of the lines'
  int first_viewer = 0, end_viewer = 0;            // of the lines'
  int first_block = 0;                             // of the lines', see blockOfPair()
};

// What an inertial unit or wheels say of two or three cameras (bundle_inertia.h).
struct StructuredInertia {
  int index = 0;                            // in the problem's turns, speed changes or ways
  std::array<int, 3> cameras{-1, -1, -1};   // -1: there is none
  std::array<int, 3> unknowns{-1, -1, -1};  // of these; -1: fixed
  std::array<int, 6> blocks{};              // of their pairs, see blockOfPair(); of free ones alone
};

// The order of some observations: their indices by what they are of and by camera, equal ones in the order given.
struct ObservationOrder {
  std::vector<int> first;  // of each point or line in `order`; and one past the last
  std::vector<int> order;
};

// A 6x6 block of the reduced system, row >= column: indices of unknowns.
struct BlockPlace {
  int row = 0, column = 0;
};

struct BundleStructure {
  std::vector<StructuredPoint> points;
  std::vector<StructuredObservation> observations;
  std::vector<CameraFrame> rows;  // camera_T_row of those read while their camera moves
  std::vector<int> viewers;       // unknown of each viewer of each point, ascending within a point
  std::vector<int> blocks;        // block of each pair of viewers of each point
  std::vector<StructuredLine> lines;
  std::vector<StructuredLineObservation> line_observations;
  std::vector<int> line_viewers;  // as `viewers`, of each line
  std::vector<int> line_blocks;   // as `blocks`, of each line
  std::vector<StructuredInertia> turns, speed_changes, ways;
  std::vector<int> camera_of_unknown;  // cameras that are free and observed, ascending
  std::vector<BlockPlace> places;      // of each block, by column, then row; all diagonal blocks are there
  bool dense = false;                  // all blocks of the lower triangle are there

  // Kept between calls for their memory.
  ObservationOrder of_points, of_lines;
  std::vector<int> unknown_of_camera;
  std::vector<int> block_of_pair;  // of unknowns, column by column; -1: there is none
};

// Where in `blocks` a point's, or a line's, pair of viewers stands, counted from its first; `row` >= `column`.
inline int blockOfPair(int row, int column) { return row * (row + 1) / 2 + column; }

// True where nothing of it keeps an adjustment from using it: all numbers, sigmas and depths over 0, directions and
// bearings of lines unit.
bool usable(const BundlePoint& point);
bool usable(const Measurement& measurement);
bool usable(const BundleLine& line);
bool usable(const BundleLineObservation& observation);
bool usable(const BundleTurn& turn);
bool usable(const BundleWay& way);
bool usable(const BundleSpeedChange& change);

// Indices must be in range. Takes out observations without effect (by the point's own host, of or by what is not
// usable, or where nothing is free), and points and lines that have none left. Up to `most_dense` free cameras the
// reduced system has all its blocks.
void structureBundle(const Camera& camera, const BundleProblem& problem, int most_dense, BundleStructure& structure);

}  // namespace edgeslam
