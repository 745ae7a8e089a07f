// The map as records for files and the report (P28): edge points with their direction in space, in the order of their
// edges, and lines.
#pragma once

#include "map/map.h"
#include "pipeline/run_result.h"

namespace edgeslam {

// Those from `first` on; earlier ones are of the run that made a saved map.
std::vector<KeyframeRecord> keyframeRecords(const Map& map, KeyframeId first = 0);

// Chain numbers are made unique over the map (a chain belongs to one host keyframe).
std::vector<MapPointRecord> mapPointRecords(const Map& map, const Camera& camera);

// Of the lines that are placed, by number.
std::vector<MapLineRecord> mapLineRecords(const Map& map);

}  // namespace edgeslam
