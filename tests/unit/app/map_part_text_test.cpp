#include "app/map_part_text.h"

#include <gtest/gtest.h>

#include <limits>

#include "edgeslam/input_error.h"

namespace edgeslam {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(ParseMapBox, ReadsThreeRanges) {
  const MapBox box = parseMapBox("-1:2.5,:,0.5:");
  EXPECT_EQ(box.least, Eigen::Vector3d(-1, -infinity, 0.5));
  EXPECT_EQ(box.most, Eigen::Vector3d(2.5, infinity, infinity));
  EXPECT_TRUE(parseMapBox(":,:,:").holds({1e9, -1e9, 0}));
}

TEST(ParseMapBox, RefusesWhatIsNoBox) {
  for (const char* text : {"", "1:2", "1:2,3:4", "1:2,3:4,5:6,7:8", "1,2,3",
                           "a:b,:,:", "nan:1,:,:", "inf:,:,:", "2:1,:,:", "1:2:3,:,:", "1: 2x,:,:"}) {
    EXPECT_THROW(parseMapBox(text), InputError) << text;
  }
}

TEST(ParseKeyframeRange, ReadsOneOrMany) {
  EXPECT_EQ(parseKeyframeRange("3:17"), (std::pair<KeyframeId, KeyframeId>{3, 17}));
  EXPECT_EQ(parseKeyframeRange("5"), (std::pair<KeyframeId, KeyframeId>{5, 5}));
}

TEST(ParseKeyframeRange, RefusesWhatIsNone) {
  for (const char* text : {"", ":", "1:", ":2", "2:1", "-1:3", "1:2:3", "a", "1.5", "99999999999"}) {
    EXPECT_THROW(parseKeyframeRange(text), InputError) << text;
  }
}

}  // namespace
}  // namespace edgeslam
