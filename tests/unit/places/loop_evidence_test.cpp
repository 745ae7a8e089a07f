// P26: what counts for a loop: depths as certain as they say on either side, and inliers all over the image.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstring>

#include "places/loop_verification.h"
#include "unit/adjustment/synthetic_scene.h"
#include "unit/places/made_place.h"

namespace edgeslam {
namespace {

constexpr int kThere = 4;          // keyframes of the old side, from 0 on
constexpr KeyframeId between = 4;  // looks the other way
constexpr KeyframeId current_here = 6, candidate_there = 1;

// A place seen from nearly the same poses twice, with nothing in common in the map.
class LoopEvidence : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const std::vector<Pose> round = test::turnAround(24, 0);
    std::vector<Pose> poses(round.begin(), round.begin() + kThere);
    poses.push_back(round[12]);
    for (int k = 0; k < kThere; ++k) {
      poses.push_back(round[static_cast<std::size_t>(k)]);
      poses.back().translation += Eigen::Vector3d(0.05, 0.03, -0.03);
    }
    place = new Map(test::makePlace(7, test::placeCamera(), poses));
  }
  static void TearDownTestSuite() { delete place; }

  enum class Side { there, here };
  static Side sideOf(const MapPoint& point) { return point.host < between ? Side::there : Side::here; }

  // Depths of one side are off by `off` and say so much: both as the standard deviation of their logarithm.
  static void blurDepths(Side side, double off, double said, Map& map) {
    test::Random random(side == Side::there ? 1 : 2);
    for (auto& [id, point] : map.points) {
      if (sideOf(point) != side) continue;
      point.inverse_depth *= std::exp(test::gaussian(random, off));
      point.inverse_depth_sigma = said * point.inverse_depth;
    }
  }

  LoopVerification verify(const Map& map, const LoopVerificationOptions& options = onlyDescriptors()) const {
    return verifyLoop(camera, {}, map, current_here, candidate_there, options, 1);
  }
  static LoopVerificationOptions onlyDescriptors() {
    LoopVerificationOptions options;
    options.search.witnesses = 0;
    return options;
  }

  static Map* place;
  const Camera camera = test::placeCamera();
};

Map* LoopEvidence::place = nullptr;

TEST_F(LoopEvidence, DepthsMayBeOffByWhatTheySayOnBothSides) {
  const LoopVerification exact = verify(*place);
  ASSERT_GT(exact.descriptor_inliers, 30) << exact.reason;
  Map map = *place;
  blurDepths(Side::there, 0.3, 0.3, map);
  blurDepths(Side::here, 0.3, 0.3, map);
  const LoopVerification blurred = verify(map);
  EXPECT_GT(blurred.descriptor_inliers, 0.8 * exact.descriptor_inliers) << blurred.reason;
}

TEST_F(LoopEvidence, DepthsThatAreFartherOffThanTheySaySpeakAgainstIt) {
  for (const Side side : {Side::there, Side::here}) {
    for (const double said : {0.01, 0.15}) {
      Map map = *place;
      blurDepths(side, 1.5, said, map);
      const LoopVerification wrong = verify(map);
      EXPECT_LT(wrong.descriptor_inliers, 0.6 * wrong.descriptor_pairs) << wrong.reason;
    }
  }
}

// Parts of the image that hold inliers, out of 16: where all of the old side's points are seen in one half of the
// image, no more than a half of them and their neighbours.
TEST_F(LoopEvidence, InliersInOneHalfOfTheImageAreInHalfOfItsParts) {
  const auto partsWith = [&](const Map& map) {
    LoopVerificationOptions options = onlyDescriptors();
    options.fewest_cells = 17;
    options.fewest_needed_inliers = options.most_needed_inliers = 10;
    options.least_found_share = 0;
    options.fewest_descriptor_inliers = 8;
    const std::string reason = verify(map, options).reason;
    const char* found = std::strstr(reason.c_str(), "inliers in ");
    int parts = -1;
    if (!found || std::sscanf(found, "inliers in %d of 16", &parts) != 1) ADD_FAILURE() << reason;
    return parts;
  };
  const auto seenIn = [&](auto inside) {
    Map map = *place;
    const Pose camera_T_world = map.keyframes[current_here].world_T_camera.inverse();
    for (auto point = map.points.begin(); point != map.points.end();) {
      const Eigen::Vector3d seen = camera_T_world * worldPosition(map, point->second);
      const bool keep = sideOf(point->second) == Side::here || (seen.z() > 0.1 && inside(project(camera, seen)));
      point = keep ? std::next(point) : map.points.erase(point);
    }
    return partsWith(map);
  };
  const int all = partsWith(*place), upper = seenIn([](const Eigen::Vector2d&p) { return p.y() < 112; }),
            lower = seenIn([](const Eigen::Vector2d&p) { return p.y() > 128; }),
            left = seenIn([](const Eigen::Vector2d&p) { return p.x() < 152; }),
            right = seenIn([](const Eigen::Vector2d&p) { return p.x() > 168; });
  EXPECT_GT(all, 12);
  EXPECT_LE(all, 16);
  for (const int half : {upper, lower, left, right}) {
    EXPECT_LE(half, 8);
    EXPECT_GE(half, 5);
  }
}

}  // namespace
}  // namespace edgeslam
