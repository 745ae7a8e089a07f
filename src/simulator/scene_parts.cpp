#include "simulator/scene_parts.h"

#include <Eigen/Geometry>
#include <cmath>

namespace edgeslam {
namespace {

using Eigen::Vector3d;

Vector3d onWall(const SceneWall& wall, double right, double up, double out) {
  return wall.origin + right * wall.right + up * Vector3d::UnitZ() + out * wall.right.cross(Vector3d::UnitZ());
}

void addFace(Scene& scene, const Vector3d& corner, const Vector3d& s, const Vector3d& t, double albedo) {
  SceneRectangle face;
  face.corner = corner;
  face.side_s = s;
  face.side_t = t;
  face.albedo = albedo;
  scene.rectangles.push_back(face);
}

}  // namespace

void addBox(Scene& scene, const Vector3d& origin, const Vector3d& a, const Vector3d& b, const Vector3d& c,
            double albedo, bool bottom) {
  addFace(scene, origin, c, b, albedo);
  addFace(scene, origin + a, b, c, albedo);
  addFace(scene, origin, a, c, albedo);
  addFace(scene, origin + b, c, a, albedo);
  addFace(scene, origin + c, a, b, albedo);
  if (bottom) addFace(scene, origin, b, a, albedo);
}

void addUprightBox(Scene& scene, const Vector3d& centre, const Vector3d& size, double yaw, double albedo, bool bottom) {
  const Vector3d a = size.x() * Vector3d(std::cos(yaw), std::sin(yaw), 0);
  const Vector3d b = size.y() * Vector3d(-std::sin(yaw), std::cos(yaw), 0);
  addBox(scene, centre - 0.5 * a - 0.5 * b, a, b, size.z() * Vector3d::UnitZ(), albedo, bottom);
}

std::vector<SceneWall> addRoomShell(Scene& scene, const Vector3d& minimum, const Vector3d& maximum, double floor_albedo,
                                    double wall_albedo, double ceiling_albedo) {
  const Vector3d size = maximum - minimum;
  const Vector3d x = size.x() * Vector3d::UnitX(), y = size.y() * Vector3d::UnitY(), z = size.z() * Vector3d::UnitZ();
  addFace(scene, minimum, x, y, floor_albedo);
  addFace(scene, minimum + z, y, x, ceiling_albedo);
  std::vector<SceneWall> walls = {{minimum + x, -Vector3d::UnitX(), size.x()},
                                  {minimum + x + y, -Vector3d::UnitY(), size.y()},
                                  {minimum + y, Vector3d::UnitX(), size.x()},
                                  {minimum, Vector3d::UnitY(), size.y()}};
  for (const SceneWall& wall : walls) addFace(scene, wall.origin, wall.length * wall.right, z, wall_albedo);
  return walls;
}

void addPicture(Scene& scene, const SceneWall& wall, double left, double bottom, double width, double height,
                double albedo, int texture, double lift) {
  addFace(scene, onWall(wall, left, bottom, lift), width * wall.right, height * Vector3d::UnitZ(), albedo);
  scene.rectangles.back().texture = texture;
  scene.rectangles.back().casts_shadow = false;
}

void addLedge(Scene& scene, const SceneWall& wall, double left, double bottom, double width, double height,
              double depth, double albedo) {
  const std::size_t first = scene.rectangles.size();
  // The face on the wall itself is that at c = 0, which addBox leaves out.
  addBox(scene, onWall(wall, left, bottom, 0), width * wall.right, height * Vector3d::UnitZ(),
         depth * wall.right.cross(Vector3d::UnitZ()), albedo);
  if (depth > 0.05) return;
  for (std::size_t i = first; i < scene.rectangles.size(); ++i) scene.rectangles[i].casts_shadow = false;
}

void addDoor(Scene& scene, const SceneWall& wall, double left, double leaf_albedo, int texture) {
  constexpr double height = 2.02, frame_depth = 0.025, frame_albedo = 0.42;
  addPicture(scene, wall, left, 0, door_leaf_width, height, leaf_albedo, texture);
  addLedge(scene, wall, left - door_frame_width, 0, door_frame_width, height + door_frame_width, frame_depth,
           frame_albedo);
  addLedge(scene, wall, left + door_leaf_width, 0, door_frame_width, height + door_frame_width, frame_depth,
           frame_albedo);
  addLedge(scene, wall, left, height, door_leaf_width, door_frame_width, frame_depth, frame_albedo);
  addLedge(scene, wall, left + door_leaf_width - 0.1, 0.98, 0.04, 0.2, 0.01, 0.75);
  addLedge(scene, wall, left + door_leaf_width - 0.2, 1.05, 0.13, 0.02, 0.05, 0.8);
}

void addWindow(Scene& scene, const SceneWall& wall, double left, double bottom, double width, double height,
               double emission) {
  constexpr double frame = 0.06, depth = 0.04, albedo = 0.85;
  addPicture(scene, wall, left, bottom, width, height, 1, -1);
  scene.rectangles.back().emission = emission;
  addLedge(scene, wall, left - frame, bottom, frame, height, depth, albedo);
  addLedge(scene, wall, left + width, bottom, frame, height, depth, albedo);
  addLedge(scene, wall, left - frame, bottom + height, width + 2 * frame, frame, depth, albedo);
  addLedge(scene, wall, left + 0.5 * (width - frame), bottom, frame, height, depth, albedo);
  addLedge(scene, wall, left - 2 * frame, bottom - 0.04, width + 4 * frame, 0.04, 0.16, albedo);
}

void addSkirting(Scene& scene, const SceneWall& wall, const std::vector<double>& doors, double albedo) {
  constexpr double height = 0.1, depth = 0.015;
  double from = 0;
  for (const double door : doors) {
    addLedge(scene, wall, from, 0, door - door_frame_width - from, height, depth, albedo);
    from = door + door_leaf_width + door_frame_width;
  }
  addLedge(scene, wall, from, 0, wall.length - from, height, depth, albedo);
}

void addTable(Scene& scene, const Vector3d& centre, double length, double depth, double height, double yaw) {
  constexpr double thickness = 0.035, leg = 0.05;
  addUprightBox(scene, centre + Vector3d(0, 0, height - thickness), {length, depth, thickness}, yaw, 0.6, true);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(yaw, Vector3d::UnitZ()).toRotationMatrix();
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      const Vector3d offset(x * (length - 3 * leg), y * (depth - 3 * leg), 0);
      addUprightBox(scene, centre + turn * offset, {leg, leg, height - thickness}, yaw, 0.35);
    }
  }
}

void addCeilingLamp(Scene& scene, const Vector3d& centre, double length, double width, double intensity) {
  addFace(scene, centre + Vector3d(-0.5 * length, -0.5 * width, -0.01), width * Vector3d::UnitY(),
          length * Vector3d::UnitX(), 1);
  scene.rectangles.back().emission = 2.2;
  scene.rectangles.back().casts_shadow = false;
  for (const double x : {-0.35, 0.35}) {
    for (const double y : {-0.35, 0.35}) {
      scene.lights.push_back({centre + Vector3d(x * length, y * width, -0.03), -Vector3d::UnitZ(), intensity / 4});
    }
  }
}

}  // namespace edgeslam
