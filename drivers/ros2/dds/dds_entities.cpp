#include "drivers/ros2/dds/dds_entities.h"

#include <cstdlib>
#include <utility>

namespace edgeslam {
namespace {

constexpr const char* localhost_only =
    "<CycloneDDS><Domain><General><Interfaces><NetworkInterface address=\"127.0.0.1\"/></Interfaces></General></Domain>"
    "</CycloneDDS>";

bool isLocalhostOnly() {
  const char* wanted = std::getenv("ROS_LOCALHOST_ONLY");
  return wanted && std::string(wanted) == "1";
}

}  // namespace

DdsEntity::~DdsEntity() {
  if (isThere()) dds_delete(entity_);
}

DdsEntity& DdsEntity::operator=(DdsEntity&& other) noexcept {
  std::swap(entity_, other.entity_);
  return *this;
}

DdsQuality ddsQuality(const TopicQuality& quality) {
  DdsQuality qos(dds_create_qos(), &dds_delete_qos);
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, /*max_blocking_time=*/0);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, quality.kept);
  const bool is_kept_for_late_ones = quality.durability == DdsDurability::transient_local;
  dds_qset_durability(qos.get(), is_kept_for_late_ones ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  if (is_kept_for_late_ones) {
    dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, quality.kept, DDS_LENGTH_UNLIMITED,
                                DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  }
  const dds_data_representation_id_t classic = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(qos.get(), 1, &classic);
  return qos;
}

DdsEntity openParticipant(int domain, DdsEntity& domain_entity) {
  const auto number = static_cast<dds_domainid_t>(domain);
  if (isLocalhostOnly()) {
    const char* others = std::getenv("CYCLONEDDS_URI");
    const std::string configuration = std::string(others ? others : "") + (others ? "," : "") + localhost_only;
    domain_entity = DdsEntity(dds_create_domain(number, configuration.c_str()));
  }
  return DdsEntity(dds_create_participant(number, nullptr, nullptr));
}

}  // namespace edgeslam
