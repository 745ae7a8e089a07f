// What `edgeslam map info` says of a saved map.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "map/map_file.h"

namespace edgeslam {

// Lines for people, and the same figures for programs. `bytes`: of the file.
std::string mapInfoText(const std::string& path, std::uint64_t bytes, const SavedMap& saved);
nlohmann::json mapInfoJson(const std::string& path, std::uint64_t bytes, const SavedMap& saved);

// What differs between the calibrations of two maps, in words with figures: "fx is 520.9, the other's is 525"; empty
// where nothing does.
std::string calibrationDifference(const Camera& camera, const Camera& other);

}  // namespace edgeslam
