// What the program has in DDS: a participant, and for each topic a writer with the quality of service that ROS 2's
// subscribers expect.
#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <memory>
#include <string>

#include "drivers/ros2/dds/dds_log.h"

namespace edgeslam {

// A handle of DDS, with what was made of it.
class DdsEntity {
 public:
  DdsEntity() = default;
  explicit DdsEntity(dds_entity_t entity) : entity_(entity) {}
  ~DdsEntity();
  DdsEntity(DdsEntity&& other) noexcept : entity_(other.entity_) { other.entity_ = 0; }
  DdsEntity& operator=(DdsEntity&& other) noexcept;

  dds_entity_t get() const { return entity_; }
  bool isThere() const { return entity_ > 0; }

 private:
  dds_entity_t entity_ = 0;  // negative: an error's number
};

enum class DdsDurability { volatile_, transient_local };

struct TopicQuality {
  std::int32_t kept = 10;  // samples for subscribers that have not taken them in yet
  DdsDurability durability = DdsDurability::volatile_;
};

// Reliable, and keeps the last ones: a subscriber that does not read loses old samples, and the writer does not wait.
using DdsQuality = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>;
DdsQuality ddsQuality(const TopicQuality& quality);

// By CYCLONEDDS_URI of the environment; where ROS_LOCALHOST_ONLY is 1, on this computer alone, as ROS 2 programs do.
// `domain_entity` is to outlive the participant.
DdsEntity openParticipant(int domain, DdsEntity& domain_entity);

}  // namespace edgeslam
