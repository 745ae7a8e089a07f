// ROS 2's messages as Fast CDR decodes them, field by field as the published definitions have them: not by our IDL.
#pragma once

#include <fastcdr/Cdr.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace edgeslam::decoded {

using eprosima::fastcdr::Cdr;

struct Header {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
  std::string frame_id;
  std::int64_t stamp_ns() const { return 1'000'000'000LL * sec + nanosec; }
};
inline void decode(Cdr& cdr, Header& header) { cdr >> header.sec >> header.nanosec >> header.frame_id; }
inline void encode(Cdr& cdr, const Header& header) { cdr << header.sec << header.nanosec << header.frame_id; }

struct Pose {
  static constexpr const char* type = "geometry_msgs::msg::dds_::PoseWithCovarianceStamped_";
  Header header;
  std::array<double, 3> position{};
  std::array<double, 4> orientation{};  // x, y, z, w
  std::array<double, 36> covariance{};
};
inline void decode(Cdr& cdr, Pose& pose) {
  decode(cdr, pose.header);
  cdr >> pose.position >> pose.orientation >> pose.covariance;
}

struct Odometry {
  static constexpr const char* type = "nav_msgs::msg::dds_::Odometry_";
  Header header;
  std::string child_frame_id;
  std::array<double, 3> position{};
  std::array<double, 4> orientation{};
  std::array<double, 36> covariance{};
  std::array<double, 3> linear{}, angular{};
  std::array<double, 36> twist_covariance{};
};
inline void decode(Cdr& cdr, Odometry& odometry) {
  decode(cdr, odometry.header);
  cdr >> odometry.child_frame_id >> odometry.position >> odometry.orientation >> odometry.covariance;
  cdr >> odometry.linear >> odometry.angular >> odometry.twist_covariance;
}

struct Transform {
  Header header;
  std::string child_frame_id;
  std::array<double, 3> translation{};
  std::array<double, 4> rotation{};  // x, y, z, w
};
struct Transforms {
  static constexpr const char* type = "tf2_msgs::msg::dds_::TFMessage_";
  std::vector<Transform> transforms;
};
inline void decode(Cdr& cdr, Transforms& message) {
  std::uint32_t count = 0;
  cdr >> count;
  message.transforms.clear();
  for (std::uint32_t i = 0; i < count; ++i) {
    Transform transform;
    decode(cdr, transform.header);
    cdr >> transform.child_frame_id >> transform.translation >> transform.rotation;
    message.transforms.push_back(transform);
  }
}
inline void encode(Cdr& cdr, const Transforms& message) {
  cdr << static_cast<std::uint32_t>(message.transforms.size());
  for (const Transform& transform : message.transforms) {
    encode(cdr, transform.header);
    cdr << transform.child_frame_id << transform.translation << transform.rotation;
  }
}

struct PointField {
  std::string name;
  std::uint32_t offset = 0, count = 0;
  std::uint8_t datatype = 0;
};
struct Cloud {
  static constexpr const char* type = "sensor_msgs::msg::dds_::PointCloud2_";
  Header header;
  std::uint32_t height = 0, width = 0, point_step = 0, row_step = 0;
  std::vector<PointField> fields;
  bool is_bigendian = true, is_dense = false;
  std::vector<std::uint8_t> data;
};
inline void decode(Cdr& cdr, Cloud& cloud) {
  decode(cdr, cloud.header);
  std::uint32_t count = 0;
  cdr >> cloud.height >> cloud.width >> count;
  cloud.fields.clear();
  for (std::uint32_t i = 0; i < count; ++i) {
    PointField field;
    cdr >> field.name >> field.offset >> field.datatype >> field.count;
    cloud.fields.push_back(field);
  }
  cdr >> cloud.is_bigendian >> cloud.point_step >> cloud.row_step >> cloud.data >> cloud.is_dense;
}

struct Diagnosis {
  std::uint8_t level = 255;
  std::string name, message, hardware_id;
  std::vector<std::array<std::string, 2>> values;
};
struct Diagnostics {
  static constexpr const char* type = "diagnostic_msgs::msg::dds_::DiagnosticArray_";
  Header header;
  std::vector<Diagnosis> status;
};
inline void decode(Cdr& cdr, Diagnostics& diagnostics) {
  decode(cdr, diagnostics.header);
  std::uint32_t count = 0;
  cdr >> count;
  diagnostics.status.clear();
  for (std::uint32_t i = 0; i < count; ++i) {
    Diagnosis part;
    std::uint32_t values = 0;
    cdr >> part.level >> part.name >> part.message >> part.hardware_id >> values;
    for (std::uint32_t k = 0; k < values; ++k) {
      std::array<std::string, 2> value;
      cdr >> value[0] >> value[1];
      part.values.push_back(value);
    }
    diagnostics.status.push_back(part);
  }
}

}  // namespace edgeslam::decoded
