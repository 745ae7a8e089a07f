// What the tracks of a frame say of its pose: those in the map by their points, the others by where their points may be
// on the rays of their keyframes.
#pragma once

#include <memory_resource>
#include <vector>

#include "adjustment/pose_adjustment.h"
#include "map/map_view.h"
#include "tracking/track.h"

namespace edgeslam {

// What is presumed of a track without depth.
struct UnmappedTracks {
  double inverse_depth = 0, inverse_depth_sigma = 0;
  double weakening = 1;    // its standard deviations count so many times
  double parallax_px = 0;  // by which it may be displaced besides, as nobody knows the camera's way [px]
};

// `track_of_observation`: index into the tracks of each entry that is added.
void addMapped(const Camera& camera, const MapView& view, const std::vector<Track>& tracks, const Pose& camera_T_world,
               PoseObservations& observations, std::pmr::vector<int>& track_of_observation);

// With a depth that is little more than a guess, what these tracks measure is where they are across the epipolar line
// of their keyframe.
void addUnmapped(const Camera& camera, const MapView& view, const std::vector<Track>& tracks,
                 const Pose& camera_T_world, const UnmappedTracks& presumed, PoseObservations& observations);

}  // namespace edgeslam
