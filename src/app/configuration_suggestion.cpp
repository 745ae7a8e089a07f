#include "app/configuration_suggestion.h"

#include <algorithm>
#include <cstdlib>

namespace edgeslam {
namespace {

// Damerau-Levenshtein distance (optimal string alignment).
int editDistance(const std::string& a, const std::string& b) {
  const std::size_t columns = b.size() + 1;
  std::vector<int> distance((a.size() + 1) * columns);
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      int& here = distance[i * columns + j];
      if (i == 0 || j == 0) {
        here = static_cast<int>(i + j);
        continue;
      }
      const int replaced = distance[(i - 1) * columns + j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      here = std::min({replaced, distance[(i - 1) * columns + j] + 1, distance[i * columns + j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        here = std::min(here, distance[(i - 2) * columns + j - 2] + 1);
      }
    }
  }
  return distance.back();
}

std::string lastName(const std::string& key) { return key.substr(key.rfind('.') + 1); }

}  // namespace

std::string closestKey(const std::string& wrong, const std::vector<std::string>& known) {
  constexpr std::size_t longest = 200;  // nobody's slip of the pen, and the distance is quadratic
  if (wrong.size() > longest) return "";
  std::string closest;
  int closest_distance = std::max(2, static_cast<int>(lastName(wrong).size()) / 3) + 1;
  for (const std::string& key : known) {
    const bool same_name = lastName(wrong) == lastName(key);
    const int longer = std::abs(static_cast<int>(wrong.size()) - static_cast<int>(key.size()));
    if (!same_name && longer >= closest_distance) continue;
    const int distance = same_name ? 1 : editDistance(wrong, key);
    if (distance < closest_distance) {
      closest_distance = distance;
      closest = key;
    }
  }
  return closest;
}

}  // namespace edgeslam
