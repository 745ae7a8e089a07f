#include "simulator/scene.h"

#include <Eigen/Geometry>
#include <cmath>

#include "edgeslam/input_error.h"
#include "files/format_text.h"
#include "simulator/scene_parts.h"
#include "simulator/scene_textures.h"

namespace edgeslam {
namespace {

using Eigen::Vector3d;

int addTexture(Scene& scene, SceneTexture texture) {
  scene.textures.push_back(std::move(texture));
  return static_cast<int>(scene.textures.size()) - 1;
}

// Seven panels of 1.1 m, folded alternately, in a hall; the folds' ends are 12 mm apart, so that a dark gap shows
// there.
Scene makePanels(bool posters, std::uint64_t seed) {
  constexpr double height = 1.95, thickness = 0.02, gap = 0.006;
  Scene scene;
  scene.ambient = 0.40;
  addRoomShell(scene, {-4.2, -4.6, 0}, {4.2, 2.0, 3.1}, 0.55, 0.35, 0.5);
  if (posters) scene.rectangles.front().texture = addTexture(scene, drawCarpet(2048, 2048, 0.05, seed + 1));
  addCeilingLamp(scene, {-3.4, -2.2, 3.1}, 1.2, 0.5, 15);
  addCeilingLamp(scene, {2.0, -3.6, 3.1}, 1.2, 0.5, 3);

  // Folds, left to right; uneven, as panels set up by hand are.
  const std::vector<std::pair<double, double>> folds = {{-3.32, 0.42}, {-2.36, -0.26}, {-1.43, 0.45}, {-0.52, -0.22},
                                                        {0.41, 0.50},  {1.20, -0.24},  {2.11, 0.38},  {2.95, -0.30}};
  for (std::size_t i = 0; i + 1 < folds.size(); ++i) {
    const Vector3d left(folds[i].first, folds[i].second, 0), right(folds[i + 1].first, folds[i + 1].second, 0);
    const Vector3d along = (right - left).normalized();
    const double length = (right - left).norm() - 2 * gap;
    const Vector3d back = thickness * Vector3d::UnitZ().cross(along);
    addBox(scene, left + gap * along, length * along, back, height * Vector3d::UnitZ(), 0.80);
    // Something dark behind the gap.
    SceneRectangle strip;
    strip.corner = right + Vector3d(-0.012, 0.025, 0);
    strip.side_s = 0.024 * Vector3d::UnitX();
    strip.side_t = height * Vector3d::UnitZ();
    strip.albedo = 0.08;
    strip.casts_shadow = false;
    scene.rectangles.push_back(strip);
    if (!posters) continue;
    const SceneWall panel{left + gap * along, along, length};
    const std::uint64_t poster_seed = seed * 1000 + 10 * i;
    addPicture(scene, panel, 0.07, 0.95, 0.42, 0.62, 0.95, addTexture(scene, drawPoster(420, 620, poster_seed + 1)),
               0.002);
    addPicture(scene, panel, 0.56, 0.80 + 0.05 * static_cast<double>(i % 3), length - 0.63, 0.75, 0.95,
               addTexture(scene, drawPoster(420, 700, poster_seed + 2)), 0.002);
    addPicture(scene, panel, 0.15, 0.16, 0.70, 0.5, 0.95, addTexture(scene, drawPoster(700, 500, poster_seed + 3)),
               0.002);
  }
  if (posters) {
    const Vector3d along = Vector3d(0.96, 0.28, 0), across = Vector3d(-0.28, 0.96, 0);
    for (const double x : {-1.6, 0.5}) {
      SceneRectangle rug;
      rug.corner = Vector3d(x, -1.05, 0.004);
      rug.side_s = 1.1 * along;
      rug.side_t = 0.5 * across;
      rug.albedo = 0.8;
      rug.texture = addTexture(scene, drawPoster(1100, 500, seed * 1000 + 500 + scene.textures.size()));
      rug.casts_shadow = false;
      scene.rectangles.push_back(rug);
    }
  }
  return scene;
}

Scene makeRoom(std::uint64_t seed) {
  Scene scene;
  scene.ambient = 0.42;
  const auto walls = addRoomShell(scene, {0, 0, 0}, {5.2, 4.4, 2.6}, 0.33, 0.72, 0.8);
  addCeilingLamp(scene, {2.4, 2.3, 2.6}, 0.9, 0.3, 2.8);
  const int leaf = addTexture(scene, drawDoorLeaf(128, 288, seed + 2));
  const int picture = addTexture(scene, drawPoster(512, 384, seed * 1000 + 3));

  addDoor(scene, walls[0], 3.3, 0.5, leaf);
  addLedge(scene, walls[0], 2.95, 1.1, 0.08, 0.08, 0.01, 0.9);  // light switch
  addSkirting(scene, walls[0], {3.3}, 0.86);

  addWindow(scene, walls[1], 1.1, 0.95, 1.9, 1.2, 1.1);
  scene.lights.push_back({Vector3d(5.1, 2.05, 1.6), -Vector3d::UnitX(), 1.6});
  addLedge(scene, walls[1], 1.3, 0.12, 1.5, 0.6, 0.1, 0.82);  // radiator
  addSkirting(scene, walls[1], {}, 0.86);

  addLedge(scene, walls[2], 1.9, 1.35, 0.86, 0.66, 0.02, 0.18);  // picture frame
  addPicture(scene, walls[2], 1.95, 1.4, 0.76, 0.56, 0.9, picture, 0.023);
  addLedge(scene, walls[2], 4.3, 0.3, 0.08, 0.08, 0.01, 0.9);  // socket
  addSkirting(scene, walls[2], {}, 0.86);

  addLedge(scene, walls[3], 0.5, 1.5, 1.4, 0.03, 0.25, 0.4);     // shelf
  addLedge(scene, walls[3], 0.75, 1.53, 0.2, 0.28, 0.18, 0.25);  // on it
  addLedge(scene, walls[3], 1.3, 1.53, 0.35, 0.16, 0.2, 0.6);
  addLedge(scene, walls[3], 2.9, 0, 0.9, 1.9, 0.45, 0.5);                // cupboard ...
  addPicture(scene, walls[3], 3.345, 0.05, 0.01, 1.8, 0.12, -1, 0.453);  // ... and the gap between its doors
  addSkirting(scene, walls[3], {}, 0.86);

  addTable(scene, {1.5, 3.75, 0}, 1.4, 0.7, 0.74, 0);
  addUprightBox(scene, {1.2, 3.8, 0.74}, {0.3, 0.22, 0.18}, 0.3, 0.22);
  addUprightBox(scene, {1.75, 3.9, 0.74}, {0.5, 0.03, 0.33}, -0.1, 0.12, true);
  addUprightBox(scene, {4.4, 3.7, 0}, {0.5, 0.4, 0.35}, 0.4, 0.45);
  addUprightBox(scene, {4.45, 3.65, 0.35}, {0.3, 0.3, 0.25}, 0.9, 0.6);
  addUprightBox(scene, {0.5, 0.5, 0}, {0.4, 0.4, 0.5}, 0.2, 0.5);
  return scene;
}

Scene makeCorridor(bool tiled, std::uint64_t seed) {
  const CorridorPlan plan;
  constexpr double height = 2.5;
  const double inner_length = plan.length - 2 * plan.corridor_width, inner_width = plan.width - 2 * plan.corridor_width;
  const double inner_x = plan.corridor_width, inner_y = plan.corridor_width;
  Scene scene;
  scene.ambient = 0.45;
  const auto outer = addRoomShell(scene, {0, 0, 0}, {plan.length, plan.width, height}, 0.36, 0.70, 0.7);
  if (tiled) scene.rectangles.front().texture = addTexture(scene, drawTiles(1440, 1080, 90, seed + 3));
  addBox(scene, {inner_x, inner_y, 0}, inner_length * Vector3d::UnitX(), inner_width * Vector3d::UnitY(),
         height * Vector3d::UnitZ(), 0.70);
  const std::vector<SceneWall> inner = {
      {{inner_x, inner_y, 0}, Vector3d::UnitX(), inner_length},
      {{inner_x + inner_length, inner_y, 0}, Vector3d::UnitY(), inner_width},
      {{inner_x + inner_length, inner_y + inner_width, 0}, -Vector3d::UnitX(), inner_length},
      {{inner_x, inner_y + inner_width, 0}, -Vector3d::UnitY(), inner_width}};
  const double middle = 0.5 * plan.corridor_width;
  for (const double x : {0.3, 0.7}) {
    addCeilingLamp(scene, {x * plan.length, middle, height}, 0.9, 0.2, 1.8);
    addCeilingLamp(scene, {x * plan.length, plan.width - middle, height}, 0.9, 0.2, 1.8);
  }
  addCeilingLamp(scene, {middle, 0.5 * plan.width, height}, 0.2, 0.9, 1.8);
  addCeilingLamp(scene, {plan.length - middle, 0.5 * plan.width, height}, 0.2, 0.9, 1.8);

  const int leaf = addTexture(scene, drawDoorLeaf(128, 288, seed + 2));
  const int picture_a = addTexture(scene, drawPoster(320, 400, seed * 1000 + 4));
  const int picture_b = addTexture(scene, drawPoster(400, 320, seed * 1000 + 5));
  const std::vector<std::vector<double>> outer_doors = {{1.2, 4.6}, {3.9}, {2.4, 5.8}, {0.5, 2.2}};
  const std::vector<std::vector<double>> inner_doors = {{2.0}, {}, {0.6, 2.5}, {0.7}};
  for (std::size_t side = 0; side < 4; ++side) {
    for (const double door : outer_doors[side]) addDoor(scene, outer[side], door, 0.38, leaf);
    for (const double door : inner_doors[side]) addDoor(scene, inner[side], door, 0.38, leaf);
    addSkirting(scene, outer[side], outer_doors[side], 0.3);
    addSkirting(scene, inner[side], inner_doors[side], 0.3);
  }
  addLedge(scene, outer[1], 2.2, 1.2, 0.5, 0.62, 0.02, 0.15);
  addPicture(scene, outer[1], 2.24, 1.24, 0.42, 0.54, 0.9, picture_a, 0.023);
  addLedge(scene, outer[3], 3.9, 1.25, 0.62, 0.5, 0.02, 0.85);
  addPicture(scene, outer[3], 3.94, 1.29, 0.54, 0.42, 0.9, picture_b, 0.023);
  addLedge(scene, inner[2], 1.85, 1.0, 0.16, 0.45, 0.14, 0.2);  // fire extinguisher
  addLedge(scene, outer[0], 3.2, 0, 0.4, 0.9, 0.3, 0.55);       // cabinet
  addLedge(scene, outer[2], 4.6, 1.4, 0.5, 0.35, 0.03, 0.8);    // notice board
  return scene;
}

}  // namespace

const char* sceneName(SceneKind kind) {
  switch (kind) {
    case SceneKind::panels:
      return "panels";
    case SceneKind::panels_textured:
      return "panels_textured";
    case SceneKind::room:
      return "room";
    case SceneKind::corridor:
      return "corridor";
    case SceneKind::corridor_tiled:
      return "corridor_tiled";
  }
  return "unknown";
}

SceneKind sceneKindOfName(const std::string& name) {
  for (const SceneKind kind : {SceneKind::panels, SceneKind::panels_textured, SceneKind::room, SceneKind::corridor,
                               SceneKind::corridor_tiled}) {
    if (name == sceneName(kind)) return kind;
  }
  throw InputError("unknown scene '" + name + "': expected panels, panels_textured, room, corridor or corridor_tiled");
}

Scene makeScene(SceneKind kind, std::uint64_t seed) {
  switch (kind) {
    case SceneKind::room:
      return makeRoom(seed);
    case SceneKind::corridor:
    case SceneKind::corridor_tiled:
      return makeCorridor(kind == SceneKind::corridor_tiled, seed);
    default:
      return makePanels(kind == SceneKind::panels_textured, seed);
  }
}

std::string formatSurfaces(const Scene& scene) {
  std::string text = "# the scene's triangles, world, metres: x0 y0 z0 x1 y1 z1 x2 y2 z2\n";
  const auto append = [&text](const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    text += formatted("%.6g %.6g %.6g %.6g %.6g %.6g %.6g %.6g %.6g\n", a.x(), a.y(), a.z(), b.x(), b.y(), b.z(), c.x(),
                      c.y(), c.z());
  };
  for (const SceneRectangle& r : scene.rectangles) {
    const Vector3d opposite = r.corner + r.side_s + r.side_t;
    append(r.corner, r.corner + r.side_s, opposite);
    append(r.corner, opposite, r.corner + r.side_t);
  }
  return text;
}

}  // namespace edgeslam
