// P5, P6: the tracks of the last frame are found again in this one by bidirectional flow started from the predicted
// pose, and what is redundant, inconsistent there and back, or off the edges is dropped.
#pragma once

#include <memory_resource>
#include <vector>

#include "edges/edge_detection.h"
#include "flow/optical_flow.h"
#include "geometry/camera.h"
#include "image/hidden_levels.h"
#include "map/map_view.h"
#include "tracking/sparse_alignment.h"
#include "tracking/track.h"

namespace edgeslam {

// One entry a track: where it was seen last and, on that ray, its position in that camera's frame [map units], as far
// away as its map point or, where it has none, at the scene's usual depth.
AlignmentPoints placeTracks(const Camera& camera, const std::vector<Track>& tracks, const MapView& view,
                            const Pose& world_T_last, double scene_depth,
                            std::pmr::memory_resource* memory = std::pmr::get_default_resource());

// Where each point should be seen after the camera moved; one that would be behind it, where it was. One that its
// distance would move by over a quarter of the image's width is taken to be as far as can be: its distance is wrong.
using Pixels = std::pmr::vector<Eigen::Vector2f>;

Pixels predictPixels(const Camera& camera, const AlignmentPoints& points, const Pose& world_T_last,
                     const Pose& world_T_predicted,
                     std::pmr::memory_resource* memory = std::pmr::get_default_resource());

// Median distance of the tracks' map points from the camera [map units]; `fallback` where none has one.
double medianDepth(const std::vector<Track>& tracks, const MapView& view, const Pose& world_T_camera, double fallback,
                   std::pmr::memory_resource* memory = std::pmr::get_default_resource());

// How far from a track its window reaches [px of the level].
inline int flowReach(const FlowOptions& options) { return options.window / 2 + 1; }

// One entry a track: the pixel in `to`, or nothing (found false). `hidden`: where windows of that reach see what is
// masked; on the levels where a track's does it is not followed.
using FlowMatches = std::pmr::vector<FlowMatch>;

FlowMatches followPoints(const FrameImages& from, const FrameImages& to, const std::vector<Track>& tracks,
                         const Pixels& predictions, const FlowOptions& options,
                         std::pmr::memory_resource* memory = std::pmr::get_default_resource(),
                         const HiddenLevels& hidden = {});

// P6: keeps the tracks that were found, agree there and back across their edge, lie on an edge of `edges`, and are not
// too near to an older one, with their new pixels, in place of what is in `kept`.
void filterTracks(const FrameImages& from, const FrameImages& to, const EdgeMap& edges,
                  const std::vector<Track>& tracks, const FlowMatches& matches, const FlowOptions& options,
                  std::vector<Track>& kept, std::pmr::memory_resource* memory = std::pmr::get_default_resource());

}  // namespace edgeslam
