#include "map/map_figures.h"

#include <algorithm>
#include <map>

namespace edgeslam {
namespace {

constexpr std::size_t left_out_one_in = 100;  // points at either end

MapExtent extentOfMost(const std::vector<Eigen::Vector3d>& positions) {
  MapExtent extent;
  if (positions.empty()) return extent;
  const std::size_t left_out = positions.size() / left_out_one_in;
  std::vector<double> along(positions.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::transform(positions.begin(), positions.end(), along.begin(), [=](const auto& p) { return p[axis]; });
    std::sort(along.begin(), along.end());
    extent.least[axis] = along[left_out];
    extent.most[axis] = along[along.size() - 1 - left_out];
  }
  return extent;
}

struct WorldInProgress {
  WorldFigures figures;
  const Keyframe* latest = nullptr;
  std::vector<Eigen::Vector3d> points;
};

void add(const Keyframe& keyframe, WorldInProgress& world) {
  WorldFigures& figures = world.figures;
  const Eigen::Vector3d& position = keyframe.world_T_camera.translation;
  if (!world.latest) {
    figures.world = keyframe.world;
    figures.first = keyframe.id;
    figures.first_ns = figures.last_ns = keyframe.time_ns;
    figures.cameras = {position, position};
  } else {
    figures.way += (position - world.latest->world_T_camera.translation).norm();
  }
  figures.cameras.least = figures.cameras.least.cwiseMin(position);
  figures.cameras.most = figures.cameras.most.cwiseMax(position);
  figures.last = keyframe.id;
  figures.first_ns = std::min(figures.first_ns, keyframe.time_ns);
  figures.last_ns = std::max(figures.last_ns, keyframe.time_ns);
  ++figures.keyframes;
  figures.keyframes_with_images += keyframe.images ? 1 : 0;
  world.latest = &keyframe;
}

}  // namespace

std::vector<WorldFigures> figuresOf(const Map& map) {
  std::map<int, WorldInProgress> worlds;
  for (const Keyframe& keyframe : map.keyframes) add(keyframe, worlds[keyframe.world]);
  for (const auto& [id, point] : map.points) {
    worlds[map.keyframes[point.host].world].points.push_back(worldPosition(map, point));
  }
  for (const auto& [id, line] : map.lines) {
    if (line.is_placed) ++worlds[map.keyframes[line.host].world].figures.lines;
  }
  std::vector<WorldFigures> all;
  for (auto& [number, world] : worlds) {
    world.figures.points = world.points.size();
    world.figures.most_points = extentOfMost(world.points);
    all.push_back(world.figures);
  }
  return all;
}

}  // namespace edgeslam
