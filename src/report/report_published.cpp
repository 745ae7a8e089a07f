#include "report/report_published.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <nlohmann/json.hpp>
#include <regex>

namespace edgeslam {

std::string shortSequenceName(std::string name) {
  while (!name.empty() && name.back() == '/') name.pop_back();
  name = name.substr(name.find_last_of('/') + 1);
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (name.size() > 200) return "";  // no sequence is called so, and matching recurses over the length
  name = std::regex_replace(name, std::regex("\\.(mp4|avi|mkv|bag|tgz|tar\\.gz)$"), "");
  name = std::regex_replace(name, std::regex("^(rgbd_dataset_|tum_)"), "");
  name = std::regex_replace(name, std::regex("^freiburg"), "fr");
  std::smatch match;
  const std::regex icl_office(
      "(icl[_-])?(nuim[_-])?of(fice)?(_room)?[_-]?(traj|kt)?[_-]?([0-3])([_-]?frei[_-]png|[_-]?loop|n)?");
  if (std::regex_match(name, match, icl_office)) return "office" + match[6].str();
  return name;
}

std::optional<PublishedErrors> publishedErrors(const std::string& sequence) {
  static const std::array<PublishedErrors, 11> published{{
      {"fr1_xyz", "1.31", "0.90", "9.00", "16.51", "1.21"},
      {"fr2_desk", "1.75", "0.88", "4.57", "33.67", "-"},
      {"fr2_xyz", "0.49", "0.30", "2.15", "21.41", "0.43"},
      {"fr3_structure_texture_near", "1.12", "1.58", "X", "47.63", "1.25"},
      {"fr3_structure_texture_far", "0.65", "0.77", "7.95", "121.00", "0.89"},
      {"fr3_structure_notexture_near", "8.29", "X", "X", "101.03", "-"},
      {"fr3_structure_notexture_far", "6.71", "X", "X", "41.76", "-"},
      {"office0", "3.21", "5.67", "X", "X", "-"},
      {"office1", "19.5", "X", "X", "X", "-"},
      {"office2", "2.97", "3.75", "X", "X", "-"},
      {"office3", "4.58", "16.18", "X", "X", "-"},
  }};
  const std::string name = shortSequenceName(sequence);
  const auto found = std::find_if(published.begin(), published.end(),
                                  [&name](const PublishedErrors& row) { return row.sequence == name; });
  if (found == published.end()) return std::nullopt;
  return *found;
}

nlohmann::ordered_json publishedJson(const std::optional<PublishedErrors>& published) {
  if (!published) return nullptr;
  return {{"sequence", published->sequence},
          {"errors_cm",
           {{"Edge SLAM (paper)", published->edge_slam},
            {"ORB-SLAM", published->orb_slam},
            {"LSD-SLAM", published->lsd_slam},
            {"Edge VO", published->edge_vo},
            {"PL-SLAM", published->pl_slam}}}};
}

}  // namespace edgeslam
