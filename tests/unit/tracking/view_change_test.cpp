// How the world moved from one view of the map to the next.
#include "tracking/view_change.h"

#include <gtest/gtest.h>

namespace edgeslam {
namespace {

const Similarity new_S_old{2.5, rotationExp({0.3, -0.2, 1.1}), {4, -1, 0.5}};

// Keyframes first to last along a bent path.
MapView view(KeyframeId first, KeyframeId last, const Similarity& world_S_path, int world = 0) {
  MapView view;
  view.world = world;
  for (KeyframeId id = first; id <= last; ++id) {
    const Pose path{rotationExp({0, 0.1 * id, 0}), {1.0 * id, 0.2 * id * id, 0}};
    view.keyframes.push_back({id, moved(world_S_path, path), nullptr});
  }
  return view;
}

void expectNear(const Similarity& a, const Similarity& b) {
  EXPECT_NEAR(a.scale, b.scale, 1e-12);
  EXPECT_LT(a.rotation.angularDistance(b.rotation), 1e-7);
  EXPECT_LT((a.translation - b.translation).norm(), 1e-12);
}

TEST(ViewChange, AWorldThatWasJoinedToAnotherHasItsUnit) {
  const std::optional<Similarity> change = newWorldSOldWorld(view(0, 9, {}), view(5, 12, new_S_old, 1));
  ASSERT_TRUE(change);
  expectNear(*change, new_S_old);
}

TEST(ViewChange, WithinAWorldItIsThatOfTheLatestKeyframeThatBothKnow) {
  const MapView before = view(0, 9, {}), after = view(0, 9, new_S_old);
  const std::optional<Similarity> change = newWorldSOldWorld(before, after);
  ASSERT_TRUE(change);
  EXPECT_EQ(change->scale, 1);
  const Pose latest = moved(*change, before.keyframes.back().world_T_camera);
  EXPECT_LT((latest.translation - after.keyframes.back().world_T_camera.translation).norm(), 1e-12);
  EXPECT_LT(latest.rotation.angularDistance(after.keyframes.back().world_T_camera.rotation), 1e-7);
}

TEST(ViewChange, ThereIsNoneWhereTheyShareNothing) {
  EXPECT_FALSE(newWorldSOldWorld(view(0, 4, {}), view(5, 9, {})));
  EXPECT_FALSE(newWorldSOldWorld(MapView(), view(5, 9, {})));
}

// One keyframe says nothing of the unit.
TEST(ViewChange, OfASingleKeyframeTheUnitStays) {
  const std::optional<Similarity> change = newWorldSOldWorld(view(0, 3, {}), view(3, 5, new_S_old, 1));
  ASSERT_TRUE(change);
  EXPECT_EQ(change->scale, 1);
}

}  // namespace
}  // namespace edgeslam
