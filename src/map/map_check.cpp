#include "map/map_check.h"

#include <algorithm>
#include <cmath>

namespace edgeslam {
namespace {

constexpr double unit_tolerance = 1e-5;  // of a length; normals are measured in single precision
// Beyond every map, pixel or distortion; its square and cube are still far from infinity.
constexpr double largest_number = 1e12;
constexpr std::int64_t largest_time_ns = 4'000'000'000'000'000'000;  // the difference of two still fits

// All false for NaN.
bool isBounded(double value) { return std::abs(value) <= largest_number; }
bool isPositive(double value) { return value >= 1 / largest_number && value <= largest_number; }
template <typename Vector>
bool isUnit(const Vector& vector) {
  return std::abs(vector.norm() - 1) <= unit_tolerance;
}

bool isCount(std::int64_t value) { return value >= 0 && value <= largest_count; }
bool isTime(std::int64_t time_ns) { return time_ns >= -largest_time_ns && time_ns <= largest_time_ns; }
bool isKeyframeId(KeyframeId id) { return id >= 0 && id <= largest_keyframe_id; }
bool isPlainText(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= 0x20 && c < 0x7F; });
}

std::string sizeText(int width, int height) { return std::to_string(width) + " x " + std::to_string(height); }

// The windows around a pixel are read in the image and the border around it.
bool isReadable(const Camera& camera, const Eigen::Vector2d& pixel) {
  return pixel.allFinite() && insideImage(camera, pixel, -pyramid_border);
}

std::string observationProblem(const Camera& camera, const PointObservation& observation) {
  const Measurement& measured = observation.measurement;
  if (!isReadable(camera, measured.pixel)) return "its pixel is not in the image";
  if (!isUnit(measured.normal)) return "its normal is no unit vector";
  if (!isPositive(measured.sigma_normal) || !isPositive(measured.sigma_tangent)) {
    return "its standard deviations must be greater than 0";
  }
  if (!isUnit(observation.bearing)) return "its bearing is no unit vector";
  if (observation.chain < -1 || observation.order < 0) return "its place on an edge is none";
  return "";
}

std::string straightEdgeProblem(const Camera& camera, const SeenEdge& edge) {
  if (edge.line < -1 || edge.line > largest_count) return "there is no such line";
  for (const EdgeEnd* end : {&edge.from, &edge.to}) {
    if (!isReadable(camera, end->pixel)) return "its end is not in the image";
    if (!isUnit(end->bearing)) return "its end's bearing is no unit vector";
  }
  return isPositive(edge.sigma) ? "" : "its standard deviation must be greater than 0";
}

std::string imagesProblem(const Camera& camera, const FrameImages& images) {
  if (!isCount(images.frame_index) || !isTime(images.time_ns)) return "its images' frame or time is out of range";
  if (images.pyramid.levels.empty()) return "its images are empty";
  const cv::Mat& grey = images.pyramid.levels.front();
  if (grey.type() != CV_8U) return "its image is not one of 8-bit grey values";
  if (grey.cols != camera.width || grey.rows != camera.height) {
    return "its image is " + sizeText(grey.cols, grey.rows) + " pixels, the camera's are " +
           sizeText(camera.width, camera.height);
  }
  return "";
}

std::string keyframeProblem(const Camera& camera, const Keyframe& keyframe) {
  if (!isKeyframeId(keyframe.id)) return "numbers go from 0 to " + std::to_string(largest_keyframe_id);
  if (keyframe.world < 0 || keyframe.world > largest_keyframe_id) return "there is no such world";
  if (!isCount(keyframe.frame_index) || !isTime(keyframe.time_ns)) return "its frame or time is out of range";
  if (!isUnit(keyframe.world_T_camera.rotation)) return "its rotation is no unit quaternion";
  const Eigen::Vector3d& position = keyframe.world_T_camera.translation;
  if (!std::all_of(position.data(), position.data() + 3, isBounded)) return "its position is out of range";
  if (!std::all_of(keyframe.twist.data(), keyframe.twist.data() + keyframe.twist.size(), isBounded)) {
    return "its motion while its rows were read is out of range";
  }
  if (!isPlainText(keyframe.reason)) return "its reason is not plain text";
  PointId before = -1;
  for (const PointObservation& observation : keyframe.observations) {
    const std::string place = "observation of point " + std::to_string(observation.point) + ": ";
    if (!isCount(observation.point)) return place + "there is no such number";
    if (observation.point <= before) return place + "comes after that of point " + std::to_string(before);
    const std::string problem = observationProblem(camera, observation);
    if (!problem.empty()) return place + problem;
    if (observation.straight_edge < -1 ||
        observation.straight_edge >= static_cast<std::int64_t>(keyframe.straight_edges.size())) {
      return place + "its straight edge is not there";
    }
    before = observation.point;
  }
  for (const SeenEdge& edge : keyframe.straight_edges) {
    const std::string problem = straightEdgeProblem(camera, edge);
    if (!problem.empty()) return "a straight edge: " + problem;
  }
  return keyframe.images ? imagesProblem(camera, *keyframe.images.get()) : "";
}

std::string viewProblem(const Map& map, KeyframeId id, PointId point) {
  const Keyframe* keyframe = map.keyframes.find(id);
  if (!keyframe) return "keyframe " + std::to_string(id) + ", which is not in the map";
  if (!findObservation(*keyframe, point)) return "keyframe " + std::to_string(id) + ", which has no observation of it";
  return "";
}

std::string pointProblem(const Map& map, const MapPoint& point) {
  if (!isCount(point.id)) return "there is no such number";
  if (!isUnit(point.host_bearing)) return "its bearing is no unit vector";
  if (!isPositive(point.inverse_depth)) return "its inverse depth must be greater than 0";
  if (!isBounded(point.inverse_depth_sigma) || point.inverse_depth_sigma < 0) {
    return "its inverse depth's standard deviation is negative or no number";
  }
  if (!isKeyframeId(point.chain_keyframe) || point.chain < -1 || point.order < 0) {
    return "its place on an edge is none";
  }
  const std::string host_problem = viewProblem(map, point.host, point.id);
  if (!host_problem.empty()) return "its host is " + host_problem;
  KeyframeId before = -1;
  for (const KeyframeId id : point.seen_in) {
    const std::string problem = viewProblem(map, id, point.id);
    if (!problem.empty()) return "is seen in " + problem;
    if (map.keyframes[id].world != map.keyframes[point.host].world) {
      return "is seen in keyframe " + std::to_string(id) + ", which is of another world";
    }
    if (id <= before || id == point.host) return "is seen in keyframe " + std::to_string(id) + " twice or out of order";
    before = id;
  }
  return "";
}

bool sees(const Keyframe& keyframe, LineId line) {
  return std::any_of(keyframe.straight_edges.begin(), keyframe.straight_edges.end(),
                     [=](const SeenEdge& edge) { return edge.line == line; });
}

std::string lineProblem(const Map& map, const MapLine& line) {
  if (!isCount(line.id) || line.id >= map.next_line) return "there is no such number";
  const Eigen::Vector3d& point = line.in_host.point;
  if (!std::all_of(point.data(), point.data() + 3, isBounded)) return "its place is out of range";
  if (!isUnit(line.in_host.direction)) return "its direction is no unit vector";
  if (!isBounded(line.begin) || !isBounded(line.end) || line.begin > line.end) return "its extent is none";
  if (!std::binary_search(line.seen_in.begin(), line.seen_in.end(), line.host)) {
    return "keyframe " + std::to_string(line.host) + " is its host and does not see it";
  }
  KeyframeId before = -1;
  for (const KeyframeId id : line.seen_in) {
    const Keyframe* keyframe = map.keyframes.find(id);
    const std::string place = "is seen in keyframe " + std::to_string(id);
    if (!keyframe) return place + ", which is not in the map";
    if (!sees(*keyframe, line.id)) return place + ", which has no view of it";
    if (keyframe->world != map.keyframes[line.seen_in.front()].world) return place + ", which is of another world";
    if (id <= before) return place + " twice or out of order";
    before = id;
  }
  return "";
}

std::string unknownLineProblem(const Map& map, const Keyframe& keyframe) {
  for (const SeenEdge& edge : keyframe.straight_edges) {
    if (edge.line >= 0 && map.lines.count(edge.line) == 0) {
      return "a straight edge: line " + std::to_string(edge.line) + " is not in the map";
    }
  }
  return "";
}

std::string scaleProblem(double metres_a_unit, double sigma) {
  if (!isPositive(metres_a_unit)) return "the metres of a map unit must be greater than 0";
  return sigma >= 0 && isBounded(sigma) ? "" : "the standard deviation of its scale is out of range";
}

// Of what is known only.
std::string scalesProblem(const Map& map) {
  for (const auto& [world, alignment] : map.inertia) {
    if (!alignment.is_known) continue;
    std::string problem = scaleProblem(alignment.metres_a_unit, alignment.scale_sigma);
    if (!(std::abs(alignment.gravity.norm() - standard_gravity) < 1e-3)) problem = "gravity has another length";
    if (!problem.empty()) return "scale and gravity of world " + std::to_string(world) + ": " + problem;
  }
  for (const auto& [world, scale] : map.wheels) {
    if (!scale.is_known) continue;
    const std::string problem = scaleProblem(scale.metres_a_unit, scale.sigma);
    if (!problem.empty()) return "scale by wheels of world " + std::to_string(world) + ": " + problem;
  }
  return "";
}

}  // namespace

std::string cameraProblem(const Camera& camera) {
  if (camera.model != CameraModel::pinhole_radial_tangential && camera.model != CameraModel::kannala_brandt) {
    return "camera: unknown model";
  }
  if (camera.width < 1 || camera.height < 1 || std::max(camera.width, camera.height) > largest_camera_side) {
    return "camera: images of " + sizeText(camera.width, camera.height) + " pixels";
  }
  if (!isPositive(camera.fx) || !isPositive(camera.fy)) return "camera: the focal length must be greater than 0";
  if (!isBounded(camera.cx) || !isBounded(camera.cy)) return "camera: the principal point is out of range";
  if (!std::all_of(camera.distortion.begin(), camera.distortion.end(), isBounded)) {
    return "camera: the distortion is out of range";
  }
  if (!(std::abs(camera.readout_s) <= longest_readout_s)) {
    return "camera: the readout must be -0.2 to 0.2 seconds";
  }
  return "";
}

std::string mapProblem(const Camera& camera, const Map& map) {
  for (const Keyframe& keyframe : map.keyframes) {
    std::string problem = keyframeProblem(camera, keyframe);
    if (problem.empty()) problem = unknownLineProblem(map, keyframe);
    if (!problem.empty()) return "keyframe " + std::to_string(keyframe.id) + ": " + problem;
  }
  for (const auto& [id, point] : map.points) {
    const std::string problem = point.id == id ? pointProblem(map, point) : "is kept under another number";
    if (!problem.empty()) return "point " + std::to_string(id) + ": " + problem;
  }
  if (!isCount(map.next_line)) return "the next line's number is none";
  for (const auto& [id, line] : map.lines) {
    const std::string problem = line.id == id ? lineProblem(map, line) : "is kept under another number";
    if (!problem.empty()) return "line " + std::to_string(id) + ": " + problem;
  }
  return scalesProblem(map);
}

}  // namespace edgeslam
