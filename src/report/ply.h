// The map as a PLY file (Turk 1994), for viewers and other programs.
#pragma once

#include <string>
#include <vector>

#include "pipeline/run_result.h"

namespace edgeslam {

// Binary little-endian PLY, one vertex a map point in the order given, with the properties
//   float x y z               position, world, map units
//   float dx dy dz            direction of the edge, world, unit; 0 0 0 for a corner-like point
//   int chain                 points of one edge share a number; -1: of none
//   int order                 place along the chain: neighbours in it are joined to draw the edge
//   float depth_sigma_ratio   standard deviation of the depth over the depth
//   uchar red green blue      grey of the image there, thrice
// 39 bytes a vertex.
std::string formatPly(const std::vector<MapPointRecord>& points);

}  // namespace edgeslam
