// All that can be configured of the method, one struct a stage, each with defaults that work. The configuration file
// (firmware_cfg/edgeslam.yaml) names every field.
#pragma once

#include "adjustment/bundle_adjustment.h"
#include "adjustment/pose_adjustment.h"
#include "edges/blur_gate.h"
#include "edges/edge_detection.h"
#include "edges/point_choice.h"

namespace edgeslam {

struct Settings {
  EdgeOptions edges;
  BlurGateOptions blur_gate;
  PointChoiceOptions points;
  PoseOptions pose;
  BundleOptions bundle;
};

}  // namespace edgeslam
