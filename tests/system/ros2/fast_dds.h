// A ROS 2 program in the eyes of DDS, by Fast DDS: with the quality of service that ROS 2's subscribers have.
#pragma once

#include <fastcdr/FastBuffer.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>

#include <atomic>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <functional>
#include <mutex>
#include <stdexcept>

#include "system/ros2/decoded_messages.h"

namespace edgeslam {

namespace fast = eprosima::fastdds::dds;

// Of one type; only those that have an encode() can be published.
template <typename Message>
class FastDdsType : public fast::TopicDataType {
 public:
  FastDdsType() {
    setName(Message::type);
    m_typeSize = 1 << 12;  // a first guess: payloads grow
    m_isGetKeyDefined = false;
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }

  bool serialize(void* data, eprosima::fastrtps::rtps::SerializedPayload_t* payload) override {
    if constexpr (std::is_same_v<Message, decoded::Transforms>) {
      eprosima::fastcdr::FastBuffer buffer(reinterpret_cast<char*>(payload->data), payload->max_size);
      decoded::Cdr cdr(buffer, decoded::Cdr::LITTLE_ENDIANNESS, decoded::Cdr::DDS_CDR);
      payload->encapsulation = CDR_LE;
      cdr.serialize_encapsulation();
      encode(cdr, *static_cast<const Message*>(data));
      payload->length = static_cast<std::uint32_t>(cdr.getSerializedDataLength());
      return true;
    }
    return false;
  }

  bool deserialize(eprosima::fastrtps::rtps::SerializedPayload_t* payload, void* data) override {
    try {
      eprosima::fastcdr::FastBuffer buffer(reinterpret_cast<char*>(payload->data), payload->length);
      decoded::Cdr cdr(buffer, decoded::Cdr::DEFAULT_ENDIAN, decoded::Cdr::DDS_CDR);
      cdr.read_encapsulation();
      constexpr std::uint8_t classic_little_endian = 1;  // the second byte; XCDR2's are 6 and above
      if (payload->data[0] != 0 || payload->data[1] != classic_little_endian) return false;
      decode(cdr, *static_cast<Message*>(data));
      const std::size_t unread = payload->length - cdr.getSerializedDataLength();
      return unread < 4;  // padding
    } catch (const eprosima::fastcdr::exception::Exception&) {
      return false;
    }
  }

  std::function<std::uint32_t()> getSerializedSizeProvider(void*) override {
    return [] { return 1U << 12; };
  }
  void* createData() override { return new Message; }
  void deleteData(void* data) override { delete static_cast<Message*>(data); }
  bool getKey(void*, eprosima::fastrtps::rtps::InstanceHandle_t*, bool) override { return false; }
};

class FastDdsParticipant {
 public:
  explicit FastDdsParticipant(std::uint32_t domain = 0) {
    fast::DomainParticipantQos qos;
    // Not by shared memory, which would lead out of the test's own network.
    qos.transport().use_builtin_transports = false;
    qos.transport().user_transports.push_back(std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>());
    participant_ = fast::DomainParticipantFactory::get_instance()->create_participant(domain, qos);
    if (!participant_) throw std::runtime_error("Fast DDS makes no participant");
  }
  ~FastDdsParticipant() {
    participant_->delete_contained_entities();
    fast::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }
  FastDdsParticipant(const FastDdsParticipant&) = delete;
  FastDdsParticipant& operator=(const FastDdsParticipant&) = delete;

  fast::DomainParticipant& get() { return *participant_; }

  template <typename Message>
  fast::Topic* topic(const std::string& dds_name) {
    fast::TypeSupport type(new FastDdsType<Message>);
    type.register_type(participant_);
    if (auto* known = participant_->lookup_topicdescription(dds_name)) {
      return static_cast<fast::Topic*>(known);
    }
    return participant_->create_topic(dds_name, Message::type, fast::TOPIC_QOS_DEFAULT);
  }

 private:
  fast::DomainParticipant* participant_;
};

struct SubscriberQuality {
  bool is_transient_local = false;
  int kept = 20000;
};

// Hands over what comes, in DDS's thread, and keeps it.
template <typename Message>
class FastDdsReader : private fast::DataReaderListener {
 public:
  using Hear = std::function<void(const Message&)>;

  FastDdsReader(FastDdsParticipant& participant, const std::string& dds_name, const SubscriberQuality& quality = {},
                Hear hear = nullptr)
      : hear_(std::move(hear)) {
    fast::DataReaderQos qos;
    qos.reliability().kind = fast::RELIABLE_RELIABILITY_QOS;
    qos.durability().kind =
        quality.is_transient_local ? fast::TRANSIENT_LOCAL_DURABILITY_QOS : fast::VOLATILE_DURABILITY_QOS;
    qos.history().kind = fast::KEEP_LAST_HISTORY_QOS;
    qos.history().depth = quality.kept;
    qos.resource_limits().max_samples = 0;
    qos.resource_limits().max_instances = 0;
    qos.resource_limits().max_samples_per_instance = 0;
    qos.endpoint().history_memory_policy = eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    fast::Subscriber* subscriber = participant.get().create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT);
    reader_ = subscriber->create_datareader(participant.topic<Message>(dds_name), qos, this);
    if (!reader_) throw std::runtime_error("Fast DDS makes no reader of " + dds_name);
  }
  ~FastDdsReader() override { reader_->set_listener(nullptr); }

  int publishers() const { return publishers_.load(); }
  // A topic that is there, of another type or quality.
  int mismatches() const { return mismatches_.load(); }
  // Samples that could not be decoded, or are missing from the writer's numbering.
  int wrong() const { return wrong_.load(); }
  std::size_t count() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return heard_.size();
  }
  std::vector<Message> heard() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return heard_;
  }

 private:
  void on_data_available(fast::DataReader* reader) override {
    using eprosima::fastrtps::types::ReturnCode_t;
    while (true) {
      Message message;
      fast::SampleInfo info;
      const ReturnCode_t outcome = reader->take_next_sample(&message, &info);
      if (outcome == ReturnCode_t::RETCODE_NO_DATA) return;
      if (outcome != ReturnCode_t::RETCODE_OK) {
        ++wrong_;
        return;
      }
      if (!info.valid_data) continue;
      if (hear_) hear_(message);
      const std::lock_guard<std::mutex> lock(mutex_);
      heard_.push_back(std::move(message));
    }
  }
  void on_subscription_matched(fast::DataReader*, const fast::SubscriptionMatchedStatus& status) override {
    publishers_.store(status.current_count);
  }
  void on_requested_incompatible_qos(fast::DataReader*, const fast::RequestedIncompatibleQosStatus&) override {
    ++mismatches_;
  }
  void on_sample_lost(fast::DataReader*, const fast::SampleLostStatus& status) override {
    wrong_ += status.total_count_change;
  }

  Hear hear_;
  fast::DataReader* reader_ = nullptr;
  mutable std::mutex mutex_;
  std::vector<Message> heard_;
  std::atomic<int> publishers_{0}, mismatches_{0}, wrong_{0};
};

// Another node's transforms.
class FastDdsTransforms {
 public:
  explicit FastDdsTransforms(FastDdsParticipant& participant) {
    fast::DataWriterQos qos;
    qos.reliability().kind = fast::RELIABLE_RELIABILITY_QOS;
    qos.durability().kind = fast::VOLATILE_DURABILITY_QOS;
    qos.history().depth = 100;
    fast::Publisher* publisher = participant.get().create_publisher(fast::PUBLISHER_QOS_DEFAULT);
    writer_ = publisher->create_datawriter(participant.topic<decoded::Transforms>("rt/tf"), qos);
    if (!writer_) throw std::runtime_error("Fast DDS makes no writer");
  }
  bool send(decoded::Transforms message) { return writer_->write(&message); }
  int subscribers() const {
    fast::PublicationMatchedStatus status;
    writer_->get_publication_matched_status(status);
    return status.current_count;
  }

 private:
  fast::DataWriter* writer_ = nullptr;
};

}  // namespace edgeslam
