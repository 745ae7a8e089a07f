// How far a run's map points lie from the true surfaces of a scene.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

#include "geometry/similarity.h"
#include "unit/files/temporary_folder.h"

namespace edgeslam {

using Triangle = std::array<Eigen::Vector3d, 3>;

// surfaces.txt: nine numbers a triangle.
inline std::vector<Triangle> readSurfaces(const std::string& path) {
  std::vector<Triangle> triangles;
  std::istringstream lines(fileContent(path));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream values(line);
    Triangle triangle;
    for (Eigen::Vector3d& corner : triangle) values >> corner.x() >> corner.y() >> corner.z();
    if (line[0] != '#' && values) triangles.push_back(triangle);
  }
  return triangles;
}

// Positions of a map.ply's points (39 bytes each, the position first).
inline std::vector<Eigen::Vector3d> readMapPoints(const std::string& path) {
  constexpr std::size_t bytes_a_point = 12 + 12 + 8 + 4 + 3;
  const std::string content = fileContent(path), count = "element vertex ", end = "end_header\n";
  const std::size_t begin = content.find(end) + end.size();
  const std::size_t vertices = std::stoul(content.substr(content.find(count) + count.size()));
  std::vector<Eigen::Vector3d> points;
  for (std::size_t at = begin; at + bytes_a_point <= content.size() && points.size() < vertices; at += bytes_a_point) {
    std::array<float, 3> position{};
    std::memcpy(position.data(), content.data() + at, sizeof position);
    points.emplace_back(position[0], position[1], position[2]);
  }
  return points;
}

inline double distanceToSegment(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double share = std::min(1.0, std::max(0.0, (p - a).dot(b - a) / std::max(1e-300, (b - a).squaredNorm())));
  return (p - a - share * (b - a)).norm();
}

inline double distanceToTriangle(const Eigen::Vector3d& p, const Triangle& t) {
  const Eigen::Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
  bool above = true;  // the foot of the perpendicular lies within
  double nearest = HUGE_VAL;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d &a = t[i], &b = t[(i + 1) % 3];
    above = above && normal.dot((b - a).cross(p - a)) >= 0;
    nearest = std::min(nearest, distanceToSegment(p, a, b));
  }
  return above ? std::abs(normal.dot(p - t[0])) : nearest;
}

// Median distance [map's unit after `world_T_map`], or infinity for an empty map.
inline double medianDistanceToSurfaces(const std::vector<Eigen::Vector3d>& points, const Similarity& world_T_map,
                                       const std::vector<Triangle>& triangles) {
  std::vector<double> distances;
  for (const Eigen::Vector3d& point : points) {
    double nearest = HUGE_VAL;
    for (const Triangle& triangle : triangles)
      nearest = std::min(nearest, distanceToTriangle(world_T_map * point, triangle));
    distances.push_back(nearest);
  }
  if (distances.empty()) return HUGE_VAL;
  std::nth_element(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2),
                   distances.end());
  return distances[distances.size() / 2];
}

}  // namespace edgeslam
