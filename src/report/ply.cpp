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

}  // namespace

std::string formatPly(const std::vector<MapPointRecord>& points) {
  std::string bytes =
      "ply\n"
      "format binary_little_endian 1.0\n"
      "comment Edge SLAM map: points on edges; neighbours in the order of a chain are joined\n"
      "element vertex " +
      std::to_string(points.size()) +
      "\n"
      "property float x\nproperty float y\nproperty float z\n"
      "property float dx\nproperty float dy\nproperty float dz\n"
      "property int chain\nproperty int order\n"
      "property float depth_sigma_ratio\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "end_header\n";
  for (const MapPointRecord& point : points) {
    appendVector(bytes, point.position);
    appendVector(bytes, point.edge_direction);
    appendLittleEndian(bytes, static_cast<std::uint32_t>(point.chain));
    appendLittleEndian(bytes, static_cast<std::uint32_t>(point.order));
    appendFloat(bytes, point.depth_sigma_ratio);
    bytes.append(3, static_cast<char>(point.grey));
  }
  return bytes;
}

}  // namespace edgeslam
