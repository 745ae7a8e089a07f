// The figures that Maity, Saha and Bhowmick (2017) publish for their sequences, to be shown beside ours (tables 2 and
// 3).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

namespace edgeslam {

// RMSE of the absolute keyframe trajectory error after similarity alignment [cm]. "X" is a failure, "-" not published.
struct PublishedErrors {
  std::string sequence;
  std::string edge_slam, orb_slam, lsd_slam, edge_vo, pl_slam;
};

// The name by which the papers call a sequence, lower case: "fr2_desk" for "/data/rgbd_dataset_freiburg2_desk/" and
// "fr2_desk.mp4", "office0" to "office3" for the names of ICL-NUIM's; any other name only without folder and extension.
std::string shortSequenceName(std::string name);

// By the sequence's short name ("fr2_desk", "office0"), its full one ("rgbd_dataset_freiburg2_desk",
// "office_traj0_frei_png") or a path or archive of that name. Nothing for a sequence that is not the paper's.
std::optional<PublishedErrors> publishedErrors(const std::string& sequence);

// For the pages; null for nothing.
nlohmann::ordered_json publishedJson(const std::optional<PublishedErrors>& published);

}  // namespace edgeslam
