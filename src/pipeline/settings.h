// All that can be configured of the method, one struct a stage, each with defaults that work. What the configuration
// can change of it stands in configuration/configuration_keys.cpp; the rest are constants of the method.
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

// Of the live schedule. Real-time priorities are those of SCHED_FIFO, 1 to 99; 0: the usual scheduling.
struct ThreadOptions {
  int capture_priority = 30;
  int tracking_priority = 20;
  int publishing_priority = 10;
  int mapping_nice = 0;
  int places_nice = 5;  // and in batches
  // A processor that the thread keeps to, counted from 0; -1: any.
  int tracking_processor = -1;
  int mapping_processor = -1;
  int places_processor = -1;
  bool lock_memory = false;
};

// Of the disk, by the flight recorder [MB].
struct RecordingSpace {
  double most_megabytes = 4096;
  double kept_free_megabytes = 256;
};

// Of the wheels' odometry as a motion.
struct WheelSettings {
  bool enabled = false;
  bool planar = false;
};

struct Settings {
  EdgeOptions edges;          // how edges are found, in every image
  PointChoiceOptions points;  // how points are chosen and measured, in every image
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
  ThreadOptions threads;
  RecordingSpace recording;
  WheelSettings wheels;
};

// What an inertial unit measures, which is fixed to the camera, is used.
inline void useInertia(const InertialUnit& unit, Settings& settings) {
  settings.tracking.inertia = unit;
  settings.mapping.local_adjustment.inertia = unit;
}

// The wheels beneath the camera are used.
inline void useWheels(const WheelOptions& wheels, Settings& settings) {
  settings.tracking.wheels = wheels;
  settings.mapping.local_adjustment.wheels = wheels;
  settings.mapping.uncertainty.wheels = wheels;
}

}  // namespace edgeslam
