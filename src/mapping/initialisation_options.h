// What the start of the map asks for (section 3.3 of the paper, P13 to P15).
#pragma once

#include "adjustment/bundle_adjustment.h"
#include "mapping/quality_factor.h"

namespace edgeslam {

struct InitialisationOptions {
  int frames_between = 8;     // frames adjusted between the first and the current one
  int attempt_interval = 5;   // frames from one attempt to the next ...
  double fading_share = 0.6;  // ... or one, where less than this share of the first frame's points is left
  // Frames after the first: with fewer, depths of edge points make any motion fit.
  int fewest_frames = 2;
  // To begin with, median motion in the image less what a rotation explains [px] ...
  double least_displacement_px = 3;
  double least_displacement_deg = 0.41;  // ... or this angle, in a small image with many corners, of a run's first map
  double least_parallax_deg = 1.0;       // median angle under which the points see the two cameras [deg]
  double prior_sigma = 0.5;              // of the inverse depth around 1
  double largest_depth_sigma = 0.15;     // a point counts where its depth's standard deviation is below this share
  int fewest_points = 100;               // points that must count ...
  double point_share = 0.4;              // ... or this share of those followed, where the scene has less
  double outlier = 3.0;                  // whitened error of an observation
  int five_point_corners = 50;           // corner-like points from which on the five-point start is tried as well
  // Rivals are adjusted with about so many points first. Those whose error is below this ratio to the least one are
  // then adjusted with all, at most so many of them.
  int screened_points = 100;
  double screened_error_ratio = 1.1;
  int most_rivals = 2;
  double least_quality = 0.6;  // share of the pieces that must hold (P15)
  // Of a start from fewer frames than from one attempt to the next; little speaks against such a one, so more must for
  // it.
  double early_quality = 0.75;
  int early_points = 60;  // that must count, however few are followed
  QualityOptions quality;
  BundleOptions bundle{20, 2.0};
};

}  // namespace edgeslam
