// Links between keyframes that were measured with another offset of the clocks become those of the right one.
#include "mapping/links_anew.h"

#include <gtest/gtest.h>

#include "inertia/inertial_history.h"
#include "unit/inertia/simulated_motion.h"

namespace edgeslam::test {
namespace {

constexpr std::int64_t right_ns = 30'000'000;
constexpr std::int64_t second = 1'000'000'000;

class LinksAnew : public testing::Test {
 protected:
  LinksAnew() {
    right_.offset_ns = right_ns;
    InertialHistory history(wrong_);
    for (const InertialSample& sample : samples_) history.add(sample);
    for (int k = 0; k < 5; ++k) {
      Keyframe keyframe;
      keyframe.id = k;
      keyframe.time_ns = (k + 1) * second / 2;
      if (k > 0) keyframe.inertia = {k - 1, *history.between(k * second / 2, keyframe.time_ns, {}), 0};
      map_.keyframes.push_back(std::move(keyframe));
    }
  }

  const std::vector<InertialSample> samples_ = SimulatedMotion().measured(0, 3, 200);
  const InertialUnit wrong_;
  InertialUnit right_;
  Map map_;
};

TEST_F(LinksAnew, AreThoseOfTheRightOffset) {
  InertialHistory history(right_);
  for (const InertialSample& sample : samples_) history.add(sample);
  takeLinksAnew(right_, samples_, map_);
  for (int k = 1; k < 5; ++k) {
    const InertialLink& link = map_.keyframes[k].inertia;
    const auto expected = history.between(k * second / 2, (k + 1) * second / 2, {});
    EXPECT_EQ(link.from, k - 1);
    EXPECT_EQ(link.offset_ns, right_ns);
    EXPECT_EQ(link.motion.velocity, expected->velocity);
    EXPECT_EQ(link.motion.rotation.coeffs(), expected->rotation.coeffs());
  }
}

TEST_F(LinksAnew, ThatAreRightStayAsTheyAre) {
  const Eigen::Vector3d before = map_.keyframes[2].inertia.motion.velocity;
  takeLinksAnew(wrong_, SimulatedMotion{0.9, 0.1}.measured(0, 3, 200), map_);
  EXPECT_EQ(map_.keyframes[2].inertia.motion.velocity, before);
}

TEST_F(LinksAnew, WaitForSamplesAndAreDroppedWhereTheseAreGone) {
  std::vector<InertialSample> some;
  for (const InertialSample& sample : samples_) {
    if (sample.time_ns > second && sample.time_ns < 5 * second / 2) some.push_back(sample);
  }
  takeLinksAnew(right_, some, map_);
  EXPECT_EQ(map_.keyframes[1].inertia.from, -1) << "what was felt on the way is gone";
  EXPECT_EQ(map_.keyframes[2].inertia.offset_ns, right_ns);
  EXPECT_EQ(map_.keyframes[4].inertia.offset_ns, 0) << "not all of it has come";
  EXPECT_EQ(map_.keyframes[4].inertia.from, 3);
}

}  // namespace
}  // namespace edgeslam::test
