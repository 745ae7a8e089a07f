// All that can be configured of the method, one struct a stage, each with defaults that work. The configuration file
// (firmware_cfg/edgeslam.yaml) names every field.
#pragma once

#include "mapping/mapper.h"
#include "places/loop_closing.h"
#include "places/relocalisation.h"
#include "tracking/tracker.h"

namespace edgeslam {

struct Settings {
  TrackerOptions tracking;
  MapperOptions mapping;
  bool relocalisation_enabled = true;
  RelocalisationOptions relocalisation;
  int relocalisation_interval = 2;  // lost frames from one attempt to the next
  LoopClosingOptions loops;
  // Lockstep: the map view that follows from the keyframe of frame k is taken at frame k + view_delay_frames (design,
  // section 4).
  int view_delay_frames = 2;
};

}  // namespace edgeslam
