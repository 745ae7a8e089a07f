// Drawings for the simulator's posters, pictures, doors and floors, made by rule from a seed.
#pragma once

#include <cstdint>

#include "simulator/scene.h"

namespace edgeslam {

// A poster with rich corners: shapes, bars, lines of print and mottled photographs, as `seed` has it. Sizes in texels.
SceneTexture drawPoster(int width, int height, std::uint64_t seed);

// Mottled surface (carpet) around albedo 1 with the given contrast (standard deviation of the albedo).
SceneTexture drawCarpet(int width, int height, double contrast, std::uint64_t seed);

// Square tiles `tile` texels wide, each of a slightly different grey, with dark joints.
SceneTexture drawTiles(int width, int height, int tile, std::uint64_t seed);

// Faint vertical wood grain and two recessed panels' outlines.
SceneTexture drawDoorLeaf(int width, int height, std::uint64_t seed);

}  // namespace edgeslam
