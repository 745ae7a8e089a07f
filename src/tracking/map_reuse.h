// Map reuse (design, section 5): map points that came into view again are found across their edge and followed on, so
// that what was mapped once is not mapped twice.
#pragma once

#include <optional>
#include <vector>

#include "map/map_view.h"
#include "tracking/map_confirmation.h"
#include "tracking/map_search.h"
#include "tracking/track.h"

namespace edgeslam {

struct MapReuseOptions {
  bool enabled = true;
  int interval = 5;         // frames from one search to the next; every keyframe searches besides
  double outlier_px = 1.5;  // across its edge from where it should be: farther away a found point is not believed [px]
  double spacing = 3;       // least distance from the tracks there are [px]
  int confirming_age = 3;   // keyframes after their host points confirm the map
  MapSearchOptions search;
};

// Appends the points found to the tracks, which stay sorted by id; at most until there are `most` tracks. Tells how
// many of the map's points are where they should be; nothing where there are `most` tracks already.
std::optional<PointsConfirmed> reuseMapPoints(const Camera& camera, const MapView& view, const FrameImages& images,
                                              const EdgeMap& edges, const MovingCamera& moving, std::size_t most,
                                              const MapReuseOptions& options, std::vector<Track>& tracks,
                                              std::pmr::memory_resource* memory = std::pmr::get_default_resource());

// From now on tracks of points of the view are compared with the patch of the keyframe that they are found again by.
void compareWithMap(const MapView& view, std::vector<Track>& tracks);

}  // namespace edgeslam
