#include "drivers/ros2/dds/ros_samples.h"

#include <algorithm>
#include <cstring>

namespace edgeslam {
namespace {

constexpr std::int64_t second_ns = 1'000'000'000;
constexpr std::uint8_t float32 = 7;  // of PointField.datatype

// Types by idlc have text that may be changed; nobody does.
char* textOf(const std::string& text) { return const_cast<char*>(text.c_str()); }

// Rounded down: nanoseconds are never negative.
builtin_interfaces_msg_dds__Time_ timeOf(std::int64_t stamp_ns) {
  const std::int64_t nanosecond = ((stamp_ns % second_ns) + second_ns) % second_ns;
  return {static_cast<std::int32_t>((stamp_ns - nanosecond) / second_ns), static_cast<std::uint32_t>(nanosecond)};
}

std_msgs_msg_dds__Header_ headerOf(std::int64_t stamp_ns, const std::string& frame) {
  return {timeOf(stamp_ns), textOf(frame)};
}

geometry_msgs_msg_dds__Vector3_ vectorOf(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
geometry_msgs_msg_dds__Quaternion_ rotationOf(const Eigen::Quaterniond& q) { return {q.x(), q.y(), q.z(), q.w()}; }

geometry_msgs_msg_dds__PoseWithCovariance_ poseOf(const RosPose& pose) {
  const Eigen::Vector3d& t = pose.pose.translation;
  geometry_msgs_msg_dds__PoseWithCovariance_ sample{{{t.x(), t.y(), t.z()}, rotationOf(pose.pose.rotation)}, {}};
  std::copy(pose.covariance.begin(), pose.covariance.end(), sample.covariance);
  return sample;
}

template <typename Sequence, typename Item>
void refer(Sequence& sequence, std::vector<Item>& items) {
  sequence._buffer = items.data();
  sequence._length = sequence._maximum = static_cast<std::uint32_t>(items.size());
  sequence._release = false;
}

}  // namespace

geometry_msgs_msg_dds__PoseWithCovarianceStamped_ sampleOf(const RosPose& pose) {
  return {headerOf(pose.stamp_ns, pose.frame), poseOf(pose)};
}

nav_msgs_msg_dds__Odometry_ sampleOf(const RosOdometry& odometry) {
  nav_msgs_msg_dds__Odometry_ sample{headerOf(odometry.pose.stamp_ns, odometry.pose.frame),
                                     textOf(odometry.body_frame),
                                     poseOf(odometry.pose),
                                     {{vectorOf(odometry.velocity), vectorOf(odometry.rotation_rate)}, {}}};
  std::copy(odometry.twist_covariance.begin(), odometry.twist_covariance.end(), sample.twist.covariance);
  return sample;
}

TransformsSample::TransformsSample(const std::vector<RosTransform>& transforms) {
  for (const RosTransform& transform : transforms) {
    transforms_.push_back({headerOf(transform.stamp_ns, transform.parent),
                           textOf(transform.child),
                           {vectorOf(transform.pose.translation), rotationOf(transform.pose.rotation)}});
  }
  refer(sample_.transforms, transforms_);
}

CloudSample::CloudSample(const RosCloud& cloud) {
  constexpr std::uint32_t coordinate_bytes = sizeof(float), point_bytes = 3 * coordinate_bytes;
  static const std::array<std::string, 3> names{"x", "y", "z"};
  for (std::uint32_t i = 0; i < names.size(); ++i) {
    fields_.push_back({textOf(names.at(i)), i * coordinate_bytes, float32, 1});
  }
  data_.resize(cloud.points.size() * point_bytes);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    std::memcpy(data_.data() + i * point_bytes, cloud.points[i].data(), point_bytes);
  }
  sample_.header = headerOf(cloud.stamp_ns, cloud.frame);
  sample_.height = 1;
  sample_.width = static_cast<std::uint32_t>(cloud.points.size());
  refer(sample_.fields, fields_);
  sample_.is_bigendian = false;
  sample_.point_step = point_bytes;
  sample_.row_step = static_cast<std::uint32_t>(data_.size());
  refer(sample_.data, data_);
  sample_.is_dense = true;
}

DiagnosticsSample::DiagnosticsSample(const RosDiagnostics& diagnostics) {
  static const std::string no_frame, hardware = "edgeslam";
  values_.resize(diagnostics.parts.size());
  for (std::size_t i = 0; i < diagnostics.parts.size(); ++i) {
    const RosDiagnosis& part = diagnostics.parts[i];
    for (const auto& [key, value] : part.values) values_[i].push_back({textOf(key), textOf(value)});
    parts_.push_back(
        {static_cast<std::uint8_t>(part.level), textOf(part.name), textOf(part.message), textOf(hardware), {}});
    refer(parts_.back().values, values_[i]);
  }
  sample_.header = headerOf(diagnostics.stamp_ns, no_frame);
  refer(sample_.status, parts_);
}

RosTransform transformOf(const geometry_msgs_msg_dds__TransformStamped_& sample) {
  const auto& time = sample.header.stamp;
  const auto& t = sample.transform.translation;
  const auto& q = sample.transform.rotation;
  return {second_ns * time.sec + time.nanosec,
          sample.header.frame_id ? sample.header.frame_id : "",
          sample.child_frame_id ? sample.child_frame_id : "",
          {Eigen::Quaterniond(q.w, q.x, q.y, q.z), {t.x, t.y, t.z}}};
}

}  // namespace edgeslam
