// The map as a PLY file (Turk 1994), for viewers and other programs.
#pragma once

#include <string>
#include <vector>

#include "pipeline/run_result.h"

namespace edgeslam {

// Binary little-endian PLY. One vertex a map point in the order given, then two a line, its ends, with the properties
//   float x y z               position, world, map units
//   float dx dy dz            direction of the edge, world, unit; 0 0 0 for a corner-like point
//   int chain                 points of one edge share a number; -1: of none, and of the ends of a line
//   int order                 place along the chain: neighbours in it are joined to draw the edge
//   float depth_sigma_ratio   standard deviation of the depth over the depth; 0 for the ends of a line
//   uchar red green blue      grey of the image there, thrice; orange for the ends of a line
// 39 bytes a vertex. Then one edge a line, with the numbers of its two vertices
//   int vertex1 vertex2
std::string formatPly(const std::vector<MapPointRecord>& points, const std::vector<MapLineRecord>& lines);

}  // namespace edgeslam
