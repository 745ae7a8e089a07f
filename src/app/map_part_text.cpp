#include "app/map_part_text.h"

#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "edgeslam/input_error.h"
#include "files/text_file.h"
#include "map/map_check.h"

namespace edgeslam {
namespace {

std::vector<std::string_view> partsOf(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t end = text.find(separator); end != std::string_view::npos; end = text.find(separator)) {
    parts.push_back(text.substr(0, end));
    text.remove_prefix(end + 1);
  }
  parts.push_back(text);
  return parts;
}

[[noreturn]] void failBox(const std::string& text, const std::string& problem) {
  throw InputError("box '" + text + "': " + problem +
                   "; expected X:X,Y:Y,Z:Z, from the least to the most in map units, as -1:2.5,:,0:");
}

double boundOf(const std::string& text, std::string_view bound, double unbounded) {
  if (bound.empty()) return unbounded;
  const std::optional<double> number = parseNumber(bound);
  if (!number) failBox(text, "'" + std::string(bound) + "' is no number");
  return *number;
}

KeyframeId keyframeOf(const std::string& text, std::string_view number) {
  const std::optional<std::int64_t> id = number.empty() ? std::nullopt : parseNanoseconds(number);
  if (id && *id >= 0 && *id <= largest_keyframe_id) return static_cast<KeyframeId>(*id);
  throw InputError("keyframes '" + text + "': expected FIRST:LAST, numbers of keyframes as `map info` tells them");
}

}  // namespace

MapBox parseMapBox(const std::string& text) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const std::vector<std::string_view> axes = partsOf(text, ',');
  if (axes.size() != 3) failBox(text, "has not three ranges");
  MapBox box;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    const std::vector<std::string_view> bounds = partsOf(axes[i], ':');
    if (bounds.size() != 2) failBox(text, "'" + std::string(axes[i]) + "' is no range");
    box.least[axis] = boundOf(text, bounds[0], -infinity);
    box.most[axis] = boundOf(text, bounds[1], infinity);
    if (box.least[axis] > box.most[axis]) failBox(text, "'" + std::string(axes[i]) + "' ends before it begins");
  }
  return box;
}

std::pair<KeyframeId, KeyframeId> parseKeyframeRange(const std::string& text) {
  const std::vector<std::string_view> ends = partsOf(text, ':');
  if (ends.size() > 2) keyframeOf(text, "");
  const KeyframeId first = keyframeOf(text, ends.front()), last = keyframeOf(text, ends.back());
  if (last < first) throw InputError("keyframes '" + text + "': the last one comes before the first");
  return {first, last};
}

}  // namespace edgeslam
