#include "report/ply.h"

#include <gtest/gtest.h>

#include <cstring>

namespace edgeslam {
namespace {

constexpr std::size_t vertex_bytes = 39;

std::string body(const std::string& ply) {
  const std::string end = "end_header\n";
  return ply.substr(ply.find(end) + end.size());
}

template <typename Value>
Value valueAt(const std::string& bytes, std::size_t at) {
  Value value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

TEST(Ply, HoldsEveryPropertyInTheDocumentedOrder) {
  std::vector<MapPointRecord> points(2);
  points[1].position = {1.5, -2.25, 1e-3};
  points[1].edge_direction = {0, 0.6, -0.8};
  points[1].chain = 70000;
  points[1].order = -2;
  points[1].depth_sigma_ratio = 0.125F;
  points[1].grey = 200;
  points[0].position.setZero();
  points[0].edge_direction.setZero();
  const std::string bytes = body(formatPly(points, {}));
  ASSERT_EQ(bytes.size(), 2 * vertex_bytes);
  EXPECT_EQ(valueAt<std::int32_t>(bytes, 24), -1);
  const std::string second = bytes.substr(vertex_bytes);
  const float floats[]{1.5F, -2.25F, 1e-3F, 0.0F, 0.6F, -0.8F};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(valueAt<float>(second, 4 * i), floats[i]);
  EXPECT_EQ(valueAt<std::int32_t>(second, 24), 70000);
  EXPECT_EQ(valueAt<std::int32_t>(second, 28), -2);
  EXPECT_EQ(valueAt<float>(second, 32), 0.125F);
  for (std::size_t i = 36; i < vertex_bytes; ++i) EXPECT_EQ(valueAt<unsigned char>(second, i), 200);
}

TEST(Ply, TheHeaderSaysWhatFollows) {
  const std::string ply = formatPly(std::vector<MapPointRecord>(3, {{0, 0, 0}, {0, 0, 0}, 1, 1, 0, 0}), {});
  EXPECT_EQ(ply.rfind("ply\nformat binary_little_endian 1.0\n", 0), 0U);
  EXPECT_NE(ply.find("element vertex 3\n"), std::string::npos);
  std::size_t at = 0;
  for (const char* property : {"float x", "float y", "float z", "float dx", "float dy", "float dz", "int chain",
                               "int order", "float depth_sigma_ratio", "uchar red", "uchar green", "uchar blue"}) {
    const std::size_t found = ply.find("property " + std::string(property) + "\n", at);
    ASSERT_NE(found, std::string::npos) << property;
    at = found;
  }
}

TEST(Ply, LinesAreEdgesBetweenVerticesOfTheirOwn) {
  const std::vector<MapPointRecord> points(3);
  std::vector<MapLineRecord> lines(2);
  lines[1].from = {1, 2, 3};
  lines[1].to = {1, 2, 5};
  const std::string ply = formatPly(points, lines);
  EXPECT_NE(ply.find("element vertex 7\n"), std::string::npos);
  EXPECT_NE(ply.find("element edge 2\nproperty int vertex1\nproperty int vertex2\nend_header\n"), std::string::npos);
  const std::string bytes = body(ply);
  ASSERT_EQ(bytes.size(), 7 * vertex_bytes + 2 * 8);
  const std::string ends = bytes.substr(5 * vertex_bytes);
  const float from[]{1, 2, 3, 0, 0, 1}, to[]{1, 2, 5, 0, 0, 1};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(valueAt<float>(ends, 4 * i), from[i]);
    EXPECT_EQ(valueAt<float>(ends, vertex_bytes + 4 * i), to[i]);
  }
  EXPECT_EQ(valueAt<std::int32_t>(ends, 24), -1);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(valueAt<std::int32_t>(ends, 2 * vertex_bytes + 4 * i), 3 + static_cast<std::int32_t>(i));
  }
  // A line of no length has no direction, and is no trouble.
  EXPECT_EQ(valueAt<float>(bytes.substr(3 * vertex_bytes), 12), 0);
}

TEST(Ply, AnEmptyMapIsAValidFile) {
  EXPECT_NE(formatPly({}, {}).find("element vertex 0\n"), std::string::npos);
  EXPECT_EQ(body(formatPly({}, {})), "");
}

}  // namespace
}  // namespace edgeslam
