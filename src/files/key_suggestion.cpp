#include "files/key_suggestion.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace edgeslam {
namespace {

// Damerau-Levenshtein distance (optimal string alignment) where it is under `most`, or else `most`. Only what lies near
// the diagonal can be under it.
int editDistance(const std::string& a, const std::string& b, int most) {
  const int rows = static_cast<int>(a.size()), columns = static_cast<int>(b.size());
  if (std::abs(rows - columns) >= most) return most;
  std::vector<int> before_last, last(b.size() + 1, most), here(b.size() + 1, most);
  for (int j = 0; j <= std::min(columns, most); ++j) last[static_cast<std::size_t>(j)] = j;
  for (int i = 1; i <= rows; ++i) {
    std::fill(here.begin(), here.end(), most);
    if (i < most) here[0] = i;
    int least = here[0];
    for (int j = std::max(1, i - most); j <= std::min(columns, i + most); ++j) {
      const auto at = static_cast<std::size_t>(j), row = static_cast<std::size_t>(i);
      const int replaced = last[at - 1] + (a[row - 1] == b[at - 1] ? 0 : 1);
      here[at] = std::min({replaced, last[at] + 1, here[at - 1] + 1, most});
      const bool is_swapped = i > 1 && j > 1 && a[row - 1] == b[at - 2] && a[row - 2] == b[at - 1];
      if (is_swapped) here[at] = std::min(here[at], before_last[at - 2] + 1);
      least = std::min(least, here[at]);
    }
    if (least == most) return most;
    before_last = last;
    std::swap(last, here);
  }
  return last.back();
}

std::string lastName(const std::string& key) { return key.substr(key.rfind('.') + 1); }

}  // namespace

std::string closestKey(const std::string& wrong, const std::vector<std::string>& known) {
  constexpr std::size_t longest = 200;  // nobody's slip of the pen, and the distance is quadratic
  if (wrong.size() > longest) return "";
  std::string closest;
  const int letters = static_cast<int>(lastName(wrong).size());
  const int most_edits = letters <= 3 ? 1 : std::max(2, letters / 3);
  int closest_distance = most_edits + 1;
  for (const std::string& key : known) {
    const bool same_name = lastName(wrong) == lastName(key);
    const int distance = same_name ? 1 : editDistance(wrong, key, closest_distance);
    if (distance < closest_distance) {
      closest_distance = distance;
      closest = key;
    }
  }
  return closest;
}

}  // namespace edgeslam
