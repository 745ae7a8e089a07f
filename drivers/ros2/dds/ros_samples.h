// Plain messages as samples for DDS, of the types by idlc. A sample points into what it is made of, and copies no text
// and no points that need not be.
#pragma once

#include <ros_types.h>

#include <vector>

#include "drivers/ros2/ros_wire.h"

namespace edgeslam {

geometry_msgs_msg_dds__PoseWithCovarianceStamped_ sampleOf(const RosPose& pose);
nav_msgs_msg_dds__Odometry_ sampleOf(const RosOdometry& odometry);

// Those that are lists keep them beside the sample, so they stay where they are.
class TransformsSample {
 public:
  explicit TransformsSample(const std::vector<RosTransform>& transforms);
  TransformsSample(const TransformsSample&) = delete;
  const tf2_msgs_msg_dds__TFMessage_* get() const { return &sample_; }

 private:
  std::vector<geometry_msgs_msg_dds__TransformStamped_> transforms_;
  tf2_msgs_msg_dds__TFMessage_ sample_{};
};

class CloudSample {
 public:
  explicit CloudSample(const RosCloud& cloud);
  CloudSample(const CloudSample&) = delete;
  const sensor_msgs_msg_dds__PointCloud2_* get() const { return &sample_; }

 private:
  std::vector<sensor_msgs_msg_dds__PointField_> fields_;
  std::vector<std::uint8_t> data_;
  sensor_msgs_msg_dds__PointCloud2_ sample_{};
};

class DiagnosticsSample {
 public:
  explicit DiagnosticsSample(const RosDiagnostics& diagnostics);
  DiagnosticsSample(const DiagnosticsSample&) = delete;
  const diagnostic_msgs_msg_dds__DiagnosticArray_* get() const { return &sample_; }

 private:
  std::vector<std::vector<diagnostic_msgs_msg_dds__KeyValue_>> values_;
  std::vector<diagnostic_msgs_msg_dds__DiagnosticStatus_> parts_;
  diagnostic_msgs_msg_dds__DiagnosticArray_ sample_{};
};

// One that came from another.
RosTransform transformOf(const geometry_msgs_msg_dds__TransformStamped_& sample);

}  // namespace edgeslam
