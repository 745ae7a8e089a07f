#include "app/configuration_suggestion.h"

#include <gtest/gtest.h>

namespace edgeslam {
namespace {

const std::vector<std::string> known{"edges.sigma", "edges.sigma_ratio", "points.spacing", "pose.huber"};

TEST(ClosestKey, SeesThroughSlips) {
  EXPECT_EQ(closestKey("edges.sigam", known), "edges.sigma");
  EXPECT_EQ(closestKey("edges.sgma", known), "edges.sigma");
  EXPECT_EQ(closestKey("edge.sigma", known), "edges.sigma");
  EXPECT_EQ(closestKey("edges.sigmaratio", known), "edges.sigma_ratio");
  EXPECT_EQ(closestKey("points.spaceing", known), "points.spacing");
}

TEST(ClosestKey, FindsTheNameInAnotherSection) { EXPECT_EQ(closestKey("tracking.huber", known), "pose.huber"); }

TEST(ClosestKey, SaysNothingWhereNothingIsNear) {
  EXPECT_EQ(closestKey("camera.exposure", known), "");
  EXPECT_EQ(closestKey("", known), "");
  EXPECT_EQ(closestKey(std::string(1000000, 'e'), known), "");
  EXPECT_EQ(closestKey("edges.sigma", {}), "");
}

}  // namespace
}  // namespace edgeslam
