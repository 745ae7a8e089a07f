// All that can be configured of the method, one struct a stage, each with defaults that work. The configuration file
// (firmware_cfg/edgeslam.yaml) names every field.
#pragma once

#include "mapping/mapper.h"
#include "places/loop_closing.h"
#include "places/relocalisation.h"
#include "tracking/tracker.h"

namespace edgeslam {

// Of the map as a whole.
struct PlacesOptions {
  int old_keyframes = 20;          // a part of the map is old so many keyframes after it was left ...
  int old_points = 20;             // ... and met again with so many of its points
  int iterations_after_loop = 40;  // of the adjustment of the whole map: a closed loop leaves it far from its minimum
  int global_interval_keyframes = 25;  // P20: from one global adjustment to the next ...
  double global_interval_s = 25;       // ... at the latest
};

struct Settings {
  TrackerOptions tracking;
  MapperOptions mapping;
  bool relocalisation_enabled = true;
  RelocalisationOptions relocalisation;
  LoopClosingOptions loops;
  PlacesOptions places;
  // Lockstep (design, section 4): what mapping makes of frame k is taken at frame k + view_delay_frames, what places
  // makes of a keyframe before the keyframe so many later.
  int view_delay_frames = 2;
  int correction_delay_keyframes = 1;
};

}  // namespace edgeslam
