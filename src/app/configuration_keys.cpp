#include "app/configuration_keys.h"

#include <charconv>
#include <cmath>

namespace edgeslam {
namespace {

ConfigurationKey heading(const std::string& section, const std::string& documentation) {
  return {section, std::monostate{}, "", 0, 0, documentation};
}

}  // namespace

std::vector<ConfigurationKey> configurationKeys(Settings& settings) {
  EdgeOptions& edges = settings.tracking.edges;
  BlurGateOptions& blur_gate = settings.tracking.blur_gate;
  PointChoiceOptions& points = settings.tracking.points;
  PoseOptions& pose = settings.tracking.pose;
  BundleOptions& bundle = settings.mapping.local_adjustment.bundle;
  return {
      heading("edges", "Edges: zero crossings of a difference of Gaussians, joined into chains"),
      {"edges.sigma", &edges.sigma, "px", 0.3, 10, "standard deviation of the narrower Gaussian"},
      {"edges.sigma_ratio", &edges.sigma_ratio, "", 1.05, 4,
       "standard deviation of the wider Gaussian over the narrower's"},
      {"edges.plane_fit_radius", &edges.plane_fit_radius, "px", 1, 7,
       "a plane is fitted over (2 r + 1)^2 pixels of the difference"},
      {"edges.sign_balance", &edges.sign_balance, "", 0, 1, "most |positive - negative| / all signs in that window"},
      {"edges.gradient_threshold", &edges.gradient_threshold, "grey/px", 0, 100, "least gradient across an edge"},
      {"edges.shortest_chain", &edges.shortest_chain, "points", 1, 1000, "shorter chains are no edges"},

      heading("blur_gate", "Blurred frames: told by the variance of the grey values at the edge points"),
      {"blur_gate.share_of_average", &blur_gate.share_of_average, "", 0, 1,
       "less of the average sharpness is blurred; 0 lets all pass"},
      {"blur_gate.forgetting", &blur_gate.forgetting, "", 0, 0.9999, "weight of the past in the average, a frame"},
      {"blur_gate.longest_rejection", &blur_gate.longest_rejection, "frames", 1, 1000,
       "after as many in a row the average starts anew"},

      heading("points", "Choice of the points to track, and how exactly each is measured"),
      {"points.count", &points.count, "points", 50, 5000, "points tracked at once"},
      {"points.spacing", &points.spacing, "px", 1, 100, "least distance between two points"},
      {"points.cell", &points.cell, "px", 4, 1000, "side of a cell of the grid over which points are spread"},
      {"points.corner_share", &points.corner_share, "", 0, 1,
       "most of the points that corner-like ones may take first"},
      {"points.tensor_window", &points.tensor_window, "px", 3, 63, "side of the structure tensor's window"},
      {"points.corner_ratio", &points.corner_ratio, "", 0, 1,
       "corner-like: smaller over larger eigenvalue above this ..."},
      {"points.corner_strength", &points.corner_strength, "grey^2/px^2", 0, 10000,
       "... and smaller eigenvalue above this"},
      {"points.noise", &points.noise, "grey^2/px^2", 0, 10000, "noise of the structure tensor"},
      {"points.sigma_edge", &points.sigma_edge, "px", 0.01, 10, "standard deviation of a measurement across an edge"},
      {"points.sigma_corner", &points.sigma_corner, "px", 0.01, 10, "the same of a corner-like point"},
      {"points.border", &points.border, "px", 0, 200, "points keep this distance from the image's border"},

      heading("pose", "Pose of each frame: robust Gauss-Newton on the edge measurements"),
      {"pose.iterations", &pose.iterations, "", 1, 100, "most Gauss-Newton steps"},
      {"pose.huber", &pose.huber, "sigma", 0.1, 100, "from here on the error of a measurement counts linearly"},
      {"pose.outlier", &pose.outlier, "sigma", 0.1, 100, "from here on a measurement is an outlier"},
      {"pose.fewest", &pose.fewest, "points", 4, 1000, "with fewer measurements or inliers there is no pose"},

      heading("bundle", "Bundle adjustment of keyframes and points"),
      {"bundle.iterations", &bundle.iterations, "", 1, 1000, "most steps"},
      {"bundle.huber", &bundle.huber, "sigma", 0.1, 100, "from here on the error of a measurement counts linearly"},
  };
}

std::string numberText(double value) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof(digits), value).ptr;
  return std::string(digits, end);
}

std::string valueText(const ConfigurationField& field) {
  if (const auto* number = std::get_if<double*>(&field)) return numberText(**number);
  if (const auto* count = std::get_if<int*>(&field)) return std::to_string(**count);
  if (const auto* flag = std::get_if<bool*>(&field)) return **flag ? "true" : "false";
  return "";
}

std::string expectedValue(const ConfigurationKey& key) {
  if (std::holds_alternative<bool*>(key.field)) return "true or false";
  return numberText(key.least) + " to " + numberText(key.largest) + (key.unit.empty() ? "" : " " + key.unit);
}

bool parseNumber(const std::string& text, double& value) {
  const char* begin = text.data() + (text.size() > 1 && text[0] == '+' && text[1] != '-' ? 1 : 0);
  const char* end = text.data() + text.size();
  double number = 0;
  const auto [stop, error] = std::from_chars(begin, end, number);
  if (error != std::errc() || stop != end || !std::isfinite(number)) return false;
  value = number;
  return true;
}

std::string setValue(const ConfigurationKey& key, const std::string& text) {
  if (const auto* flag = std::get_if<bool*>(&key.field)) {
    if (text != "true" && text != "false") return "'" + text + "' is neither true nor false";
    **flag = text == "true";
    return "";
  }
  double value = 0;
  if (!parseNumber(text, value)) return "'" + text + "' is not a finite number";
  const auto* count = std::get_if<int*>(&key.field);
  if (count && value != std::floor(value)) return "'" + text + "' is not a whole number";
  if (value < key.least || value > key.largest) return text + " is out of range";
  if (count) {
    **count = static_cast<int>(value);
  } else if (const auto* number = std::get_if<double*>(&key.field)) {
    **number = value;
  }
  return "";
}

}  // namespace edgeslam
