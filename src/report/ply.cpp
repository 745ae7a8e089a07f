#include "report/ply.h"

#include <cstdint>
#include <cstring>

namespace edgeslam {
namespace {

void appendLittleEndian(std::string& bytes, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>((value >> shift) & 0xFFU);
}

void appendFloat(std::string& bytes, float value) {
  static_assert(sizeof(float) == sizeof(std::uint32_t), "PLY's float has 32 bits");
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  appendLittleEndian(bytes, bits);
}

void appendVector(std::string& bytes, const Eigen::Vector3d& vector) {
  for (int i = 0; i < 3; ++i) appendFloat(bytes, static_cast<float>(vector[i]));
}

void appendVertex(std::string& bytes, const Eigen::Vector3d& position, const Eigen::Vector3d& direction, int chain,
                  int order, float depth_sigma_ratio) {
  appendVector(bytes, position);
  appendVector(bytes, direction);
  appendLittleEndian(bytes, static_cast<std::uint32_t>(chain));
  appendLittleEndian(bytes, static_cast<std::uint32_t>(order));
  appendFloat(bytes, depth_sigma_ratio);
}

constexpr char line_colour[] = {static_cast<char>(230), static_cast<char>(120), 0};  // red, green, blue

}  // namespace

std::string formatPly(const std::vector<MapPointRecord>& points, const std::vector<MapLineRecord>& lines) {
  std::string bytes =
      "ply\n"
      "format binary_little_endian 1.0\n"
      "comment Edge SLAM map: points on edges; neighbours in the order of a chain are joined. Then the ends of lines\n"
      "element vertex " +
      std::to_string(points.size() + 2 * lines.size()) +
      "\n"
      "property float x\nproperty float y\nproperty float z\n"
      "property float dx\nproperty float dy\nproperty float dz\n"
      "property int chain\nproperty int order\n"
      "property float depth_sigma_ratio\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "element edge " +
      std::to_string(lines.size()) +
      "\n"
      "property int vertex1\nproperty int vertex2\n"
      "end_header\n";
  for (const MapPointRecord& point : points) {
    appendVertex(bytes, point.position, point.edge_direction, point.chain, point.order, point.depth_sigma_ratio);
    bytes.append(3, static_cast<char>(point.grey));
  }
  for (const MapLineRecord& line : lines) {
    const Eigen::Vector3d direction = (line.to - line.from).stableNormalized();
    for (const Eigen::Vector3d* end : {&line.from, &line.to}) {
      appendVertex(bytes, *end, direction, -1, 0, 0);
      bytes.append(line_colour, 3);
    }
  }
  for (std::size_t i = 0; i < 2 * lines.size(); ++i) {
    appendLittleEndian(bytes, static_cast<std::uint32_t>(points.size() + i));
  }
  return bytes;
}

}  // namespace edgeslam
