#include "app/map_info.h"

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "files/format_text.h"
#include "map/map_figures.h"

namespace edgeslam {
namespace {

const char* modelName(CameraModel model) {
  return model == CameraModel::kannala_brandt ? "kannala_brandt" : "pinhole_radial_tangential";
}

double seconds(std::int64_t time_ns) { return 1e-9 * static_cast<double>(time_ns); }

std::string extentText(const MapExtent& extent) {
  return formatted("x %.4g to %.4g, y %.4g to %.4g, z %.4g to %.4g", extent.least.x(), extent.most.x(),
                   extent.least.y(), extent.most.y(), extent.least.z(), extent.most.z());
}

std::string cameraText(const Camera& camera) {
  std::string text =
      formatted("  camera: %s, %d x %d pixels, focal lengths %.6g and %.6g, centre %.6g, %.6g, ",
                modelName(camera.model), camera.width, camera.height, camera.fx, camera.fy, camera.cx, camera.cy);
  text += "distortion";
  for (const double coefficient : camera.distortion) text += formatted(" %.6g", coefficient);
  return text +
         (camera.readout_s == 0 ? std::string(", no readout\n") : formatted(", readout %.6g s\n", camera.readout_s));
}

std::string worldText(const WorldFigures& figures) {
  std::string text = formatted("  map %d: %zu keyframes (%d to %d), %zu of them with images, %zu points, %zu lines\n",
                               figures.world, figures.keyframes, figures.first, figures.last,
                               figures.keyframes_with_images, figures.points, figures.lines) +
                     formatted("    times %.3f s to %.3f s; way of the camera %.4g\n", seconds(figures.first_ns),
                               seconds(figures.last_ns), figures.way) +
                     "    cameras at " + extentText(figures.cameras) + "\n";
  if (figures.points > 0) text += "    98 % of the points in each of " + extentText(figures.most_points) + "\n";
  return text;
}

// Of a world whose scale is known, by inertia or by wheels.
struct WorldScale {
  double metres_per_unit = 1, sigma = 0;  // the standard deviation as a share of it
  const char* source = "";
  std::optional<Eigen::Vector3d> down;  // unit vector, the world's frame
};

std::optional<WorldScale> scaleOf(const Map& map, int world) {
  if (const auto found = map.inertia.find(world); found != map.inertia.end() && found->second.is_known) {
    const InertialAlignment& alignment = found->second;
    return WorldScale{alignment.metres_a_unit, alignment.scale_sigma, "inertia", alignment.gravity.normalized()};
  }
  if (const auto found = map.wheels.find(world); found != map.wheels.end() && found->second.is_known) {
    return WorldScale{found->second.metres_a_unit, found->second.sigma, "wheels", std::nullopt};
  }
  return std::nullopt;
}

std::string scaleText(const Map& map, int world) {
  const std::optional<WorldScale> scale = scaleOf(map, world);
  if (!scale) return "    how long a map unit is is not known (scale.metres_per_unit)\n";
  std::string text = formatted("    a map unit is %.4g m +- %.1f %%, by %s", scale->metres_per_unit, 100 * scale->sigma,
                               scale->source);
  if (scale->down) text += formatted("; down is %.3f %.3f %.3f", scale->down->x(), scale->down->y(), scale->down->z());
  return text + "\n";
}

nlohmann::json scaleJson(const Map& map, int world) {
  const std::optional<WorldScale> scale = scaleOf(map, world);
  if (!scale) return nullptr;
  nlohmann::json json{{"metres_per_unit", scale->metres_per_unit}, {"sigma", scale->sigma}, {"source", scale->source}};
  if (scale->down) json["down"] = {scale->down->x(), scale->down->y(), scale->down->z()};
  return json;
}

nlohmann::json extentJson(const MapExtent& extent) {
  const auto triple = [](const Eigen::Vector3d& v) { return nlohmann::json::array({v.x(), v.y(), v.z()}); };
  return {{"least", triple(extent.least)}, {"most", triple(extent.most)}};
}

nlohmann::json cameraJson(const Camera& camera) {
  return {{"model", modelName(camera.model)},
          {"width", camera.width},
          {"height", camera.height},
          {"fx", camera.fx},
          {"fy", camera.fy},
          {"cx", camera.cx},
          {"cy", camera.cy},
          {"distortion", camera.distortion},
          {"readout_s", camera.readout_s}};
}

nlohmann::json worldJson(const WorldFigures& figures) {
  return {{"world", figures.world},
          {"keyframes", figures.keyframes},
          {"keyframes_with_images", figures.keyframes_with_images},
          {"first_keyframe", figures.first},
          {"last_keyframe", figures.last},
          {"first_time_s", seconds(figures.first_ns)},
          {"last_time_s", seconds(figures.last_ns)},
          {"points", figures.points},
          {"lines", figures.lines},
          {"way", figures.way},
          {"cameras", extentJson(figures.cameras)},
          {"most_points", extentJson(figures.most_points)}};
}

}  // namespace

std::string mapInfoText(const std::string& path, std::uint64_t bytes, const SavedMap& saved) {
  std::string text = path +
                     formatted(": format version %u, %.2f MB\n", saved.version, 1e-6 * static_cast<double>(bytes)) +
                     cameraText(saved.camera);
  for (const WorldFigures& figures : figuresOf(saved.map)) {
    text += worldText(figures) + scaleText(saved.map, figures.world);
  }
  return text + "  lengths are in map units\n";
}

nlohmann::json mapInfoJson(const std::string& path, std::uint64_t bytes, const SavedMap& saved) {
  nlohmann::json worlds = nlohmann::json::array();
  for (const WorldFigures& figures : figuresOf(saved.map)) {
    worlds.push_back(worldJson(figures));
    worlds.back()["scale"] = scaleJson(saved.map, figures.world);
  }
  return {{"file", path},
          {"format_version", saved.version},
          {"bytes", bytes},
          {"camera", cameraJson(saved.camera)},
          {"worlds", std::move(worlds)}};
}

std::string calibrationDifference(const Camera& camera, const Camera& other) {
  if (camera.model != other.model) {
    return std::string("its model is ") + modelName(camera.model) + ", the other's is " + modelName(other.model);
  }
  const auto numbersOf = [](const Camera& c) {
    return std::array<std::pair<const char*, double>, 12>{{{"width", c.width},
                                                           {"height", c.height},
                                                           {"fx", c.fx},
                                                           {"fy", c.fy},
                                                           {"cx", c.cx},
                                                           {"cy", c.cy},
                                                           {"first distortion", c.distortion[0]},
                                                           {"second distortion", c.distortion[1]},
                                                           {"third distortion", c.distortion[2]},
                                                           {"fourth distortion", c.distortion[3]},
                                                           {"fifth distortion", c.distortion[4]},
                                                           {"readout", c.readout_s}}};
  };
  const auto its = numbersOf(camera), others = numbersOf(other);
  for (std::size_t i = 0; i < its.size(); ++i) {
    if (its[i].second == others[i].second) continue;
    return formatted("its %s is %.9g, the other's is %.9g", its[i].first, its[i].second, others[i].second);
  }
  return "";
}

}  // namespace edgeslam
