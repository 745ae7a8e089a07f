// The simulator's scenes: worlds of plain and textured rectangles with a few lamps. World frame: z up, metres, floor at
// z = 0.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

namespace edgeslam {

enum class SceneKind {
  panels,           // bare white panels, folded zig-zag, before a darker wall (TUM's structure_notexture)
  panels_textured,  // the same with posters (TUM's structure_texture)
  room,             // plain painted room: skirting, door, window, table, boxes
  corridor,         // rectangular loop of plain corridors with doors
  corridor_tiled    // the same with a floor of tiles
};

// "panels", "panels_textured", "room", "corridor", "corridor_tiled".
const char* sceneName(SceneKind kind);

inline bool isCorridor(SceneKind kind) { return kind == SceneKind::corridor || kind == SceneKind::corridor_tiled; }

// Throws InputError, with the names that exist, for any other name.
SceneKind sceneKindOfName(const std::string& name);

// Albedo in 1/255, CV_8U, row 0 at t = 0; each level has half the resolution of the one before.
struct SceneTexture {
  std::vector<cv::Mat> levels;
};

// The points corner + s * side_s + t * side_t with s and t in [0, 1]; the sides are perpendicular. Seen only from its
// front, to which side_s x side_t points.
struct SceneRectangle {
  Eigen::Vector3d corner, side_s, side_t;  // world [m]
  double albedo = 0.75;                    // times the texture's, where there is one
  int texture = -1;                        // index into Scene::textures, or -1
  double emission = 0;                     // over 0: a lamp or a window of this radiance, whatever light falls on it
  bool casts_shadow = true;                // false for what lies flat on another surface
};

struct PointLight {
  Eigen::Vector3d position;   // world [m]
  Eigen::Vector3d direction;  // unit, straight ahead; the light falls off with the cosine to it
  double intensity = 1;       // irradiance at 1 m straight ahead
};

struct Scene {
  std::vector<SceneRectangle> rectangles;
  std::vector<SceneTexture> textures;
  std::vector<PointLight> lights;
  double ambient = 0.35;  // irradiance of the light that comes evenly from everywhere
};

// The geometry depends on `kind` alone; the posters' drawings on the seed too.
Scene makeScene(SceneKind kind, std::uint64_t seed);

// Text of a surfaces file: a triangle a line, x0 y0 z0 x1 y1 z1 x2 y2 z2 [m].
std::string formatSurfaces(const Scene& scene);

// The corridor's plan, which the camera's path follows: [0, length] x [0, width] with a block in the middle.
struct CorridorPlan {
  double length = 7.2;          // outer, along x [m]
  double width = 5.4;           // outer, along y [m]
  double corridor_width = 1.6;  // [m]
};

}  // namespace edgeslam
