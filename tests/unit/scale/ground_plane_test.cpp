#include "scale/ground_plane.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/geometry/scene_fixture.h"

namespace edgeslam {
namespace {

// A robot that drives along x, its camera `height` over the ground at z = 0, in a world that is turned at random: as a
// map is. Points are known to `depth_sigma` along their rays.
struct MadeScene {
  double height = 0.8;  // [map units]
  double depth_sigma = 0.02;
  double up_error_rad = 0.05;  // of what is configured
  Random random;
  Pose world_T_level;
  GroundScene scene;

  explicit MadeScene(unsigned seed) : random(seed) { world_T_level = {random.rotation(2), random.vector(4)}; }

  void addCameras(int count, double climb = 0) {
    const Eigen::Vector3d up = (Eigen::Vector3d::UnitZ() + up_error_rad * Eigen::Vector3d(0.6, -0.8, 0)).normalized();
    for (int i = 0; i < count; ++i) {
      scene.cameras.push_back(world_T_level * Eigen::Vector3d(0.3 * i * height, 0.02 * height * i, height + climb * i));
      scene.ups.push_back(world_T_level.rotation * up);
    }
  }
  // A point at a place in the level world, seen by the camera next behind it.
  void addPoint(const Eigen::Vector3d& place, int edge) {
    const Eigen::Vector3d truth = world_T_level * place;
    std::size_t camera = 0;
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
      if ((world_T_level.inverse() * scene.cameras[i]).x() < place.x() - height) camera = i;
    }
    const Eigen::Vector3d ray = truth - scene.cameras[camera];
    scene.points.push_back({scene.cameras[camera] + (1 + random.normal(depth_sigma)) * ray, depth_sigma, camera, edge});
  }
  // Edges on a level surface, in the rectangle from (x0, y0) to (x1, y1), in heights.
  void addSurface(int edges, double z, double x0, double x1, double y0, double y1, int first_edge = 0) {
    for (int edge = 0; edge < edges; ++edge) {
      const Eigen::Vector3d from(height * random.uniform(x0, x1), height * random.uniform(y0, y1), height * z);
      const Eigen::Vector3d to(height * random.uniform(x0, x1), height * random.uniform(y0, y1), height * z);
      for (int i = 0; i < 6; ++i) addPoint(from + i / 5.0 * (to - from), first_edge + edge);
    }
  }
  // Upright edges, as of doors and furniture.
  void addWalls(int edges, double z0, double z1, int first_edge = 1000) {
    for (int edge = 0; edge < edges; ++edge) {
      const Eigen::Vector3d foot(height * random.uniform(1, 6), height * (edge % 2 ? 1.5 : -1.5), 0);
      for (int i = 0; i < 8; ++i) {
        addPoint(foot + height * random.uniform(z0, z1) * Eigen::Vector3d::UnitZ(), first_edge + edge);
      }
    }
  }
};

MadeScene usualScene(unsigned seed) {
  MadeScene made(seed);
  made.addCameras(10);
  made.addSurface(30, 0, 1, 6, -1.5, 1.5);
  made.addWalls(15, 0, 0.8);
  return made;
}

TEST(GroundPlane, TheHeightIsWithinTwoSigmaInNineteenOfTwentyScenes) {
  int within = 0;
  constexpr int scenes = 100;
  for (unsigned seed = 0; seed < scenes; ++seed) {
    const MadeScene made = usualScene(seed);
    const GroundPlane ground = findGround(made.scene, {});
    ASSERT_EQ(ground.problem, "") << seed;
    EXPECT_LT(ground.sigma, 0.03);
    EXPECT_NEAR(ground.height / made.height, 1, 0.05);
    EXPECT_LT(std::acos(ground.normal.dot(made.world_T_level.rotation * Eigen::Vector3d::UnitZ())), 0.03);
    within += std::abs(ground.height / made.height - 1) <= 2 * ground.sigma;
  }
  EXPECT_GE(within, scenes * 95 / 100);
}

TEST(GroundPlane, OfTheFloorAndATableTheFloorIsTaken) {
  MadeScene made = usualScene(1);
  made.addSurface(60, 0.6, 2, 4, -1, 1, 2000);
  const GroundPlane ground = findGround(made.scene, {});
  ASSERT_EQ(ground.problem, "");
  EXPECT_NEAR(ground.height / made.height, 1, 0.05);
}

TEST(GroundPlane, ATableWithLittleOfTheFloorInViewIsNoGround) {
  MadeScene made(2);
  made.addCameras(10);
  made.addSurface(60, 0.5, 1, 5, -1, 1);
  made.addSurface(3, 0, 2, 6, -1.5, 1.5, 2000);
  const GroundPlane ground = findGround(made.scene, {});
  EXPECT_NE(ground.problem.find("lie below the plane"), std::string::npos) << ground.problem;
}

TEST(GroundPlane, WallsAloneAreNoGround) {
  MadeScene made(3);
  made.addCameras(10);
  made.addWalls(60, 0, 0.8);
  EXPECT_NE(findGround(made.scene, {}).problem, "");
}

TEST(GroundPlane, ARampAgainstTheBodyIsNoGround) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    for (const double angle : {0.3, 0.4, 0.5}) {
      MadeScene made = usualScene(seed);
      for (Eigen::Vector3d& up : made.scene.ups) up = rotationExp(angle * up.unitOrthogonal()) * up;
      EXPECT_NE(findGround(made.scene, {}).problem, "") << seed << ", " << angle << " rad off what is vertical";
    }
  }
}

TEST(GroundPlane, OneLineIsNoGround) {
  MadeScene made(5);
  made.addCameras(10);
  made.addSurface(30, 0, 1, 6, 1.48, 1.52);
  EXPECT_NE(findGround(made.scene, {}).problem, "");
}

TEST(GroundPlane, FewPointsOrFewEdgesAreNoGround) {
  for (const int edges : {0, 1, 4}) {
    MadeScene made(6);
    made.addCameras(10);
    made.addSurface(edges, 0, 1, 6, -1.5, 1.5);
    for (const GroundPoint& point : std::vector<GroundPoint>(made.scene.points)) {
      for (int i = 0; i < 5; ++i) made.scene.points.push_back(point);
    }
    EXPECT_NE(findGround(made.scene, {}).problem, "") << edges;
  }
}

TEST(GroundPlane, ACameraThatClimbsIsTold) {
  MadeScene made(7);
  made.addCameras(10, 0.03);
  made.addSurface(40, 0, 1, 6, -1.5, 1.5);
  EXPECT_NE(findGround(made.scene, {}).problem.find("height over the plane varies"), std::string::npos)
      << findGround(made.scene, {}).problem;
}

TEST(GroundPlane, IsTheSameEveryTimeAndNeedsKeyframes) {
  const MadeScene made = usualScene(8);
  EXPECT_EQ(findGround(made.scene, {}).height, findGround(made.scene, {}).height);
  MadeScene one(9);
  one.addCameras(1);
  EXPECT_EQ(findGround(one.scene, {}).problem, "1 of 4 keyframes so far");
  EXPECT_EQ(findGround(GroundScene(), {}).problem, "0 of 4 keyframes so far");
}

// A map whose camera is 0.8 over the ground, looks ahead and sees it below.
Map groundMap(Random& random) {
  Map map;
  for (int id = 0; id < 20; ++id) {
    Keyframe keyframe;
    keyframe.id = 2 * id;
    keyframe.world_T_camera.translation = {0, 0, 0.2 * id};
    map.keyframes.push_back(keyframe);
  }
  for (int id = 0; id < 400; ++id) {
    MapPoint point;
    point.id = id;
    point.host = 2 * (id % 20);
    const Eigen::Vector3d ray(random.uniform(-1, 1), 0.8, random.uniform(1, 3));
    point.host_bearing = ray.normalized();
    point.inverse_depth = 1 / ray.norm();
    point.inverse_depth_sigma = 0.01 / ray.norm();
    point.chain = id / 10;
    point.chain_keyframe = point.host;
    map.points[id] = point;
  }
  return map;
}

TEST(GroundScene, HasTheWellKnownPointsOfTheLatestKeyframesBelowTheCamera) {
  Random random(10);
  Map map = groundMap(random);
  const Eigen::Vector3d up = -Eigen::Vector3d::UnitY();
  const GroundScene scene = groundScene(map, up, {});
  EXPECT_EQ(scene.cameras.size(), 12U);
  EXPECT_EQ(scene.cameras.back(), map.keyframes.back().world_T_camera.translation);
  EXPECT_EQ(scene.points.size(), 240U);
  for (const GroundPoint& point : scene.points) {
    EXPECT_NEAR(point.position.y(), 0.8, 1e-9);
    EXPECT_LT(point.camera, 12U);
  }
  const GroundPlane ground = findGround(scene, {});
  ASSERT_EQ(ground.problem, "");
  EXPECT_NEAR(ground.height, 0.8, 1e-6);

  for (auto& [id, point] : map.points) {
    if (id % 2 == 0) point.inverse_depth_sigma = 0.5 * point.inverse_depth;
    if (id % 4 == 1) point.host_bearing.y() = -point.host_bearing.y();
  }
  EXPECT_EQ(groundScene(map, up, {}).points.size(), 60U);
  EXPECT_TRUE(groundScene(Map(), up, {}).points.empty());
}

TEST(GroundScene, PointsWithoutAnEdgeAreEdgesOfTheirOwn) {
  Random random(11);
  Map map = groundMap(random);
  for (auto& [id, point] : map.points) point.chain = -1;
  const GroundScene scene = groundScene(map, -Eigen::Vector3d::UnitY(), {});
  std::vector<int> edges;
  for (const GroundPoint& point : scene.points) edges.push_back(point.edge);
  std::sort(edges.begin(), edges.end());
  EXPECT_EQ(std::unique(edges.begin(), edges.end()), edges.end());
}

}  // namespace
}  // namespace edgeslam
