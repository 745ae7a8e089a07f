#include "simulator/scene_lighting.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace edgeslam {
namespace {

using Eigen::Vector3d;

constexpr double node_spacing_m = 0.08;
constexpr int most_nodes = 96;
constexpr double occlusion_reach_m = 0.8;  // a surface this far away takes no even light any more
constexpr double lamp_reach_m = 8.0;
constexpr int occlusion_rays = 24;
constexpr double kEnclosed = 0.08;  // a node that gets less of the even light lies inside something

struct Occluder {
  Vector3d corner, normal, s, t;  // s and t divided by their squared lengths
};

std::vector<Occluder> occludersOf(const Scene& scene) {
  std::vector<Occluder> occluders;
  for (const SceneRectangle& r : scene.rectangles) {
    if (!r.casts_shadow) continue;
    occluders.push_back({r.corner, r.side_s.cross(r.side_t).normalized(), r.side_s / r.side_s.squaredNorm(),
                         r.side_t / r.side_t.squaredNorm()});
  }
  return occluders;
}

// Distance along the unit direction to the rectangle, or `farthest` where it is not hit before that.
double hitDistance(const Occluder& occluder, const Vector3d& origin, const Vector3d& direction, double farthest) {
  const double slope = occluder.normal.dot(direction);
  if (std::abs(slope) < 1e-9) return farthest;
  const double distance = occluder.normal.dot(occluder.corner - origin) / slope;
  if (distance <= 0 || distance >= farthest) return farthest;
  const Vector3d offset = origin + distance * direction - occluder.corner;
  const double s = occluder.s.dot(offset), t = occluder.t.dot(offset);
  return s >= 0 && s <= 1 && t >= 0 && t <= 1 ? distance : farthest;
}

// Directions with a density proportional to the cosine to z, on a spiral.
std::array<Vector3d, occlusion_rays> cosineDirections() {
  std::array<Vector3d, occlusion_rays> directions;
  for (int i = 0; i < occlusion_rays; ++i) {
    const double share = (i + 0.5) / occlusion_rays, angle = i * 2.399963229728653;  // golden angle
    directions[static_cast<std::size_t>(i)] =
        Vector3d(std::sqrt(share) * std::cos(angle), std::sqrt(share) * std::sin(angle), std::sqrt(1 - share));
  }
  return directions;
}

// Share of the even light that reaches the point.
double openness(const std::vector<Occluder>& occluders, const Vector3d& point,
                const std::array<Vector3d, occlusion_rays>& directions) {
  double open = 0;
  for (const Vector3d& direction : directions) {
    double distance = occlusion_reach_m;
    for (const Occluder& occluder : occluders) distance = hitDistance(occluder, point, direction, distance);
    open += distance / occlusion_reach_m;
  }
  return open / occlusion_rays;
}

// Irradiance of the lamps.
double lampLight(const Scene& scene, const std::vector<Occluder>& occluders, const Vector3d& point,
                 const Vector3d& normal) {
  double sum = 0;
  for (const PointLight& light : scene.lights) {
    const Vector3d offset = light.position - point;
    const double distance = offset.norm(), cosine = normal.dot(offset) / distance;
    const double lamp_cosine = -light.direction.dot(offset) / distance;
    if (cosine <= 0 || lamp_cosine <= 0 || distance > lamp_reach_m) continue;
    const bool lit = std::all_of(occluders.begin(), occluders.end(), [&](const Occluder& occluder) {
      return hitDistance(occluder, point, offset / distance, distance) >= distance;
    });
    // The fade keeps the light continuous at the lamp's reach.
    const double fade = 1 - std::pow(distance / lamp_reach_m, 2);
    if (lit) sum += light.intensity * lamp_cosine * cosine * fade / (distance * distance);
  }
  return sum;
}

// Nodes inside a thing that stands on the surface are set to the mean of their neighbours outside, since the light
// between nodes is interpolated.
void fillEnclosedNodes(cv::Mat& map, const cv::Mat& enclosed) {
  const cv::Mat known = map.clone();
  for (int row = 0; row < map.rows; ++row) {
    for (int column = 0; column < map.cols; ++column) {
      if (!enclosed.at<unsigned char>(row, column)) continue;
      float sum = 0, count = 0;
      for (int y = std::max(0, row - 2); y <= std::min(map.rows - 1, row + 2); ++y) {
        for (int x = std::max(0, column - 2); x <= std::min(map.cols - 1, column + 2); ++x) {
          if (enclosed.at<unsigned char>(y, x)) continue;
          sum += known.at<float>(y, x);
          count += 1;
        }
      }
      if (count > 0) map.at<float>(row, column) = sum / count;
    }
  }
}

}  // namespace

std::vector<cv::Mat> computeLight(const Scene& scene) {
  const std::vector<Occluder> occluders = occludersOf(scene);
  const auto local_directions = cosineDirections();
  std::vector<cv::Mat> maps;
  for (const SceneRectangle& r : scene.rectangles) {
    if (r.emission > 0) {
      maps.emplace_back(2, 2, CV_32F, cv::Scalar(r.emission));
      continue;
    }
    const Vector3d s_axis = r.side_s.normalized(), t_axis = r.side_t.normalized(), normal = s_axis.cross(t_axis);
    std::array<Vector3d, occlusion_rays> directions;
    for (std::size_t i = 0; i < directions.size(); ++i) {
      const Vector3d& d = local_directions[i];
      directions[i] = d.x() * s_axis + d.y() * t_axis + d.z() * normal;
    }
    const auto nodes = [](double length) {
      return std::clamp(static_cast<int>(std::ceil(length / node_spacing_m)) + 1, 2, most_nodes);
    };
    cv::Mat map(nodes(r.side_t.norm()), nodes(r.side_s.norm()), CV_32F);
    cv::Mat enclosed(map.size(), CV_8U);
    for (int row = 0; row < map.rows; ++row) {
      for (int column = 0; column < map.cols; ++column) {
        // A little inside the rectangle and before it, so that neighbours do not hide the node.
        const double s = std::clamp(column / (map.cols - 1.0), 0.002, 0.998);
        const double t = std::clamp(row / (map.rows - 1.0), 0.002, 0.998);
        const Vector3d point = r.corner + s * r.side_s + t * r.side_t + 0.006 * normal;
        const double open = openness(occluders, point, directions);
        enclosed.at<unsigned char>(row, column) = open < kEnclosed ? 1 : 0;
        map.at<float>(row, column) =
            static_cast<float>(scene.ambient * open + lampLight(scene, occluders, point, normal));
      }
    }
    fillEnclosedNodes(map, enclosed);
    maps.push_back(map);
  }
  return maps;
}

}  // namespace edgeslam
