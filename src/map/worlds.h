// Worlds: where the camera is lost in a place not seen before, a new map is begun beside the old one. Each has a
// coordinate frame and a unit of its own until a place is met that both have seen; then the younger one is moved into
// the older.
#pragma once

#include <vector>

#include "geometry/similarity.h"
#include "map/map.h"

namespace edgeslam {

// Two worlds are one.
struct WorldJoin {
  int from = -1, to = -1;  // the younger one, that is no more, and the older one
  Similarity to_S_from;
};

// Their numbers, ascending.
std::vector<int> worldsOf(const Map& map);

// The keyframes of a world, ascending.
std::vector<KeyframeId> keyframesOf(const Map& map, int world);

// The first keyframe of a world is its origin; -1 where there is no such world.
KeyframeId firstKeyframeOf(const Map& map, int world);
KeyframeId latestKeyframeOf(const Map& map, int world);

// The keyframe before `id` in the same world, or -1.
KeyframeId keyframeBefore(const Map& map, KeyframeId id);

// Takes out the keyframes from `first` on and the points hosted in them, which no other keyframe may see. True where
// there was one.
bool forgetFrom(Map& map, KeyframeId first);

// Takes out the keyframes of a world and their points.
void forgetWorld(Map& map, int world);

// Moves the keyframes and points of the younger world into the older.
void joinWorlds(const WorldJoin& join, Map& map);

// What is known of how the younger world lies to the earth, the older one goes by if nothing is known of it.
void joinInertia(const WorldJoin& join, Map& map);
// What is known of its scale by the wheels, likewise.
void joinWheels(const WorldJoin& join, Map& map);

}  // namespace edgeslam
