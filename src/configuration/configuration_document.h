// A configuration is one YAML document.
#pragma once

#include <optional>
#include <string>

namespace edgeslam {

struct ConfigurationProblem {
  int line = -1;  // from 0; negative where the problem has no line
  std::string text;
};

// The document after the first in `text`, if there is one. Throws YAML::Exception where `text` is no YAML.
std::optional<ConfigurationProblem> secondDocument(const std::string& text);

}  // namespace edgeslam
