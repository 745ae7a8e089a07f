// Saved maps on disk: whole or not at all, of one camera.
#pragma once

#include <string>

#include "map/map_file.h"

namespace edgeslam {

// Replaces what was there. Throws InputError where it cannot be written (what was there stays).
void saveMap(const std::string& path, const Camera& camera, const Map& map);

// For before a long run. Throws InputError where saveMap to `path` could not succeed: something other than a file
// stands there, its folder is not there, or nothing can be written in it.
void requireMapCanBeSaved(const std::string& path);

// Throws InputError where there is no such file, it is no map that decodeMap takes, or it has no keyframe.
SavedMap readMap(const std::string& path);

// Throws InputError where readMap does, or where the map was made with another calibration than `camera`. What was
// found beside that calibration, a readout where it has none and a focal length, is in `found`.
Map loadMap(const std::string& path, const Camera& camera);

}  // namespace edgeslam
