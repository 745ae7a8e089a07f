// What the simulator's scenes are put together from: boxes, walls, doors, windows, tables.
#pragma once

#include <utility>
#include <vector>

#include "simulator/scene.h"

namespace edgeslam {

// A wall seen from its front: `right` and `up` (0, 0, 1) span it, right x up points to the viewer.
struct SceneWall {
  Eigen::Vector3d origin;  // lower left corner, world [m]
  Eigen::Vector3d right;   // unit
  double length = 1;       // [m]
};

// Five or six faces of the box origin + a + b + c (right-handed, perpendicular), seen from outside; `bottom` false
// leaves out the face at c = 0.
void addBox(Scene& scene, const Eigen::Vector3d& origin, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
            const Eigen::Vector3d& c, double albedo, bool bottom = false);

// Box with vertical sides, turned by `yaw` [rad] about z; `centre` is the middle of its lower face.
void addUprightBox(Scene& scene, const Eigen::Vector3d& centre, const Eigen::Vector3d& size, double yaw, double albedo,
                   bool bottom = false);

// Floor, four walls and ceiling of [0, x] x [0, y] x [0, z], seen from inside. Returns the four walls: y = 0, x = max,
// y = max, x = 0.
std::vector<SceneWall> addRoomShell(Scene& scene, const Eigen::Vector3d& minimum, const Eigen::Vector3d& maximum,
                                    double floor_albedo, double wall_albedo, double ceiling_albedo);

// A flat picture `lift` [m] before the wall; its lower left corner at (left, bottom) on the wall.
void addPicture(Scene& scene, const SceneWall& wall, double left, double bottom, double width, double height,
                double albedo, int texture, double lift = 0.004);

// Box on the wall, `depth` [m] thick.
void addLedge(Scene& scene, const SceneWall& wall, double left, double bottom, double width, double height,
              double depth, double albedo);

// Frame, leaf and handle of a door whose leaf's left side is at `left`. `texture` of the leaf, or -1.
void addDoor(Scene& scene, const SceneWall& wall, double left, double leaf_albedo, int texture);
constexpr double door_leaf_width = 0.9;    // [m]
constexpr double door_frame_width = 0.07;  // [m]

// Frame, mullion, sill and bright pane.
void addWindow(Scene& scene, const SceneWall& wall, double left, double bottom, double width, double height,
               double emission);

// Skirting board along the whole wall but for the doors at the given left sides.
void addSkirting(Scene& scene, const SceneWall& wall, const std::vector<double>& doors, double albedo);

// Table with four legs; `centre` on the floor.
void addTable(Scene& scene, const Eigen::Vector3d& centre, double length, double depth, double height, double yaw);

// Lamp under the ceiling: a bright rectangle and four points that shine downwards from it.
void addCeilingLamp(Scene& scene, const Eigen::Vector3d& centre, double length, double width, double intensity);

}  // namespace edgeslam
