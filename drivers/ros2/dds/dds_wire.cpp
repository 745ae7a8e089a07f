// The library that is loaded where ROS 2 is wanted: RosWire by Cyclone DDS.
#include <array>
#include <cstring>
#include <set>

#include "drivers/ros2/dds/dds_entities.h"
#include "drivers/ros2/dds/ros_samples.h"
#include "drivers/ros2/ros_names.h"

namespace edgeslam {
namespace {

constexpr TopicQuality usual{};                                    // of a topic in ROS 2
constexpr TopicQuality of_transforms{100};                         // tf2's
constexpr TopicQuality of_map{1, DdsDurability::transient_local};  // who comes later gets the latest, too
constexpr int taken_at_once = 64;

class DdsWire : public RosWire {
 public:
  // Check problem() before anything else.
  explicit DdsWire(const RosWireSetup& setup) : participant_(openParticipant(setup.domain, domain_)) {
    if (!participant_.isThere()) return;
    const std::string& space = setup.topic_namespace;
    odometry_ = writer(nav_msgs_msg_dds__Odometry__desc, rosTopic(space, "odom"), usual);
    pose_ = writer(geometry_msgs_msg_dds__PoseWithCovarianceStamped__desc, rosTopic(space, "pose"), usual);
    cloud_ = writer(sensor_msgs_msg_dds__PointCloud2__desc, rosTopic(space, "map_points"), of_map);
    own_topics_ = {rosTopic(space, "odom"), rosTopic(space, "pose"), rosTopic(space, "map_points")};
    transforms_ = writer(tf2_msgs_msg_dds__TFMessage__desc, "/tf", of_transforms);
    diagnostics_ = writer(diagnostic_msgs_msg_dds__DiagnosticArray__desc, "/diagnostics", usual);
    if (setup.hears_transforms) heard_transforms_ = reader(tf2_msgs_msg_dds__TFMessage__desc, "/tf", of_transforms);
    others_ = DdsEntity(dds_create_reader(participant_.get(), DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr));
  }

  std::string problem() {
    if (participant_.isThere() && odometry_.isThere() && pose_.isThere() && cloud_.isThere() && transforms_.isThere() &&
        diagnostics_.isThere()) {
      return "";
    }
    const std::string complaint = log_.take();
    return "DDS cannot be opened" + (complaint.empty() ? "" : " (" + complaint + ")");
  }

  bool send(const RosPose& pose) override {
    const auto sample = sampleOf(pose);
    return write(pose_, &sample);
  }
  bool send(const RosOdometry& odometry) override {
    const auto sample = sampleOf(odometry);
    return write(odometry_, &sample);
  }
  bool send(const std::vector<RosTransform>& transforms) override {
    return write(transforms_, TransformsSample(transforms).get());
  }
  bool send(const RosCloud& cloud) override { return write(cloud_, CloudSample(cloud).get()); }
  bool send(const RosDiagnostics& diagnostics) override {
    return write(diagnostics_, DiagnosticsSample(diagnostics).get());
  }

  void takeTransforms(const std::function<void(const RosTransform&)>& take) override {
    takeAll(heard_transforms_, [&](const void* sample) {
      const auto& transforms = static_cast<const tf2_msgs_msg_dds__TFMessage_*>(sample)->transforms;
      for (std::uint32_t i = 0; i < transforms._length; ++i) take(transformOf(transforms._buffer[i]));
    });
  }

  std::vector<std::string> rivals() override {
    dds_guid_t own{};
    dds_get_guid(participant_.get(), &own);
    std::vector<std::string> found;
    takeAll(others_, [&](const void* sample) {
      const auto& endpoint = *static_cast<const dds_builtintopic_endpoint_t*>(sample);
      if (std::memcmp(&endpoint.participant_key, &own, sizeof(own)) == 0) return;
      for (const std::string& topic : own_topics_) {
        if (ddsTopic(topic) == endpoint.topic_name && told_.insert(topic).second) found.push_back(topic);
      }
    });
    return found;
  }

  std::string complaint() override { return log_.take(); }

 private:
  DdsEntity topic(const dds_topic_descriptor_t& type, const std::string& name) const {
    return DdsEntity(dds_create_topic(participant_.get(), &type, ddsTopic(name).c_str(), nullptr, nullptr));
  }
  // The participant takes the topic with it.
  DdsEntity writer(const dds_topic_descriptor_t& type, const std::string& name, const TopicQuality& quality) {
    topics_.push_back(topic(type, name));
    return DdsEntity(dds_create_writer(participant_.get(), topics_.back().get(), ddsQuality(quality).get(), nullptr));
  }
  DdsEntity reader(const dds_topic_descriptor_t& type, const std::string& name, const TopicQuality& quality) {
    topics_.push_back(topic(type, name));
    return DdsEntity(dds_create_reader(participant_.get(), topics_.back().get(), ddsQuality(quality).get(), nullptr));
  }

  static bool write(const DdsEntity& writer, const void* sample) {
    return dds_write(writer.get(), sample) == DDS_RETCODE_OK;
  }

  template <typename Take>
  static void takeAll(const DdsEntity& reader, const Take& take) {
    if (!reader.isThere()) return;
    std::array<void*, taken_at_once> samples{};
    std::array<dds_sample_info_t, taken_at_once> about{};
    while (true) {
      const dds_return_t count = dds_take(reader.get(), samples.data(), about.data(), taken_at_once, taken_at_once);
      if (count <= 0) return;
      for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
        if (about.at(i).valid_data) take(samples.at(i));
      }
      dds_return_loan(reader.get(), samples.data(), count);
      if (count < taken_at_once) return;
    }
  }

  DdsLog log_;
  DdsEntity domain_, participant_;
  std::vector<DdsEntity> topics_;
  DdsEntity odometry_, pose_, cloud_, transforms_, diagnostics_, heard_transforms_, others_;
  std::vector<std::string> own_topics_;
  std::set<std::string> told_;
};

}  // namespace

extern "C" __attribute__((visibility("default"))) RosWire* edgeslamOpenRosWire(const RosWireSetup& setup,
                                                                               std::string& problem) {
  auto wire = std::make_unique<DdsWire>(setup);
  problem = wire->problem();
  return problem.empty() ? wire.release() : nullptr;
}

}  // namespace edgeslam
