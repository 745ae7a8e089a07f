// Map reuse (design, section 5): map points that came into view again are found across their edge and followed on, so
// that what was mapped once is not mapped twice.
#pragma once

#include <cstdint>
#include <vector>

#include "map/map_view.h"
#include "tracking/map_search.h"
#include "tracking/track.h"

namespace edgeslam {

struct MapReuseOptions {
  bool enabled = true;
  int interval = 5;         // frames from one search for a point to the next
  double outlier_px = 1.5;  // across its edge from where it should be: farther away a found point is not believed [px]
  double spacing = 3;       // least distance from the tracks there are [px]
  MapSearchOptions search;
};

// Which of the points in view are looked for.
enum class ReuseOf {
  all,
  turn,   // those whose turn it is in this frame: the work is spread over the interval
  missed  // those that were not looked for within the interval: they just came into view
};

class MapReuse {
 public:
  explicit MapReuse(const MapReuseOptions& options);

  // Appends the points found to the tracks, which stay sorted by id; at most until there are `most` tracks. With each
  // call for a turn another frame has come.
  void addTracks(ReuseOf which, const Camera& camera, const MapView& view, const FrameImages& images,
                 const EdgeMap& edges, const MovingCamera& moving, std::size_t most, std::vector<Track>& tracks,
                 std::pmr::memory_resource* memory = std::pmr::get_default_resource());

  // The camera may be anywhere now.
  void forget() { searches_.clear(); }

 private:
  struct Search {
    PointId point = 0;
    std::int64_t frame = 0;
  };

  bool isLookedFor(ReuseOf which, PointId point) const;
  void remember(const SearchPoints& points, const VisiblePoints& visible, std::pmr::memory_resource* memory);

  MapReuseOptions options_;
  std::int64_t frame_ = 0;        // counted here: frames that the computer is too slow for have no turn
  std::vector<Search> searches_;  // the latest of each point, within the interval; ascending by point
};

// From now on tracks of points of the view are compared with the patch of the keyframe that they are found again by.
void compareWithMap(const MapView& view, std::vector<Track>& tracks);

}  // namespace edgeslam
