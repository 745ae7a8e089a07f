// The frame in which a run is drawn on a page.
#pragma once

#include <optional>
#include <string>

#include "evaluation/trajectory.h"
#include "pipeline/run_result.h"
#include "report/run_summary.h"

namespace edgeslam {

// The frame in which the report draws: x right and y up the page seen from above, z up.
struct DisplayFrame {
  Similarity display_T_world;                                               // of the estimate
  Eigen::Quaterniond display_R_reference = Eigen::Quaterniond::Identity();  // of the ground truth
  bool aligned = false;                                                     // to the ground truth
  std::string x_name = "x", y_name = "z", z_name = "-y";  // what the axes are called in the frame that the files use
};

// Aligned to the ground truth where there is an alignment, with its z up, unless the camera was held so that another of
// its axes is clearly the upward one (ICL-NUIM's y, say); otherwise the world frame with -y (up in the first keyframe's
// image) up.
DisplayFrame displayFrame(const RunResult& result, const RunSummary& summary);
DisplayFrame displayFrame(const Trajectory& trajectory, const std::optional<Similarity>& reference_T_world);

}  // namespace edgeslam
