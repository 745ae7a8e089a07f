// When straight edges become lines of the map.
#pragma once

namespace edgeslam {

struct LineOptions {
  // Association (mapping/line_association.h).
  int fewest_votes = 3;       // tracks in common that make two edges views of one line
  int recent_keyframes = 5;   // in which the tracks of a new edge were seen on lines
  double largest_misfit = 3;  // of a line's projection from an edge whose tracks do not tell [px]
  // Placement (mapping/line_placement.h).
  int fewest_keyframes = 3;       // that see a line that is placed ...
  double least_parallax_deg = 3;  // ... with this angle between the planes of two of its views [deg]
  double largest_error = 1.7;     // median over its views, whitened; with a larger one a line is none
  // Where more than this share of the points in view are on lines, all keyframes that see these are adjusted together.
  double bare_share = 0.6;
};

}  // namespace edgeslam
