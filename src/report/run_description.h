// What a reader of a run's files needs to know besides the result: what was run, on what, with which settings.
#pragma once

#include <map>
#include <string>

namespace edgeslam {

struct RunDescription {
  std::string input;     // path of the sequence as given
  std::string sequence;  // its name: the last part of the path
  std::string program_version;
  std::map<std::string, std::string> library_versions;  // "OpenCV", "Eigen", "Ceres", ...
  std::string configuration;                            // text of the configuration in effect
  std::string command_line;
};

}  // namespace edgeslam
