#include "drivers/v4l2/sensor_device.h"

#include <linux/media.h>
#include <sys/sysmacros.h>

#include <algorithm>
#include <string>
#include <vector>

namespace edgeslam {
namespace {

constexpr int most_media_devices = 32;
constexpr std::uint32_t most_parts = 4096;  // of a kind, in a media device

struct Topology {
  std::vector<media_v2_entity> entities;
  std::vector<media_v2_interface> interfaces;
  std::vector<media_v2_pad> pads;
  std::vector<media_v2_link> links;
};

std::optional<Topology> topologyOf(const Device& media) {
  media_v2_topology parts{};
  if (media.control(MEDIA_IOC_G_TOPOLOGY, &parts) < 0) return std::nullopt;
  for (const std::uint32_t count : {parts.num_entities, parts.num_interfaces, parts.num_pads, parts.num_links}) {
    if (count > most_parts) return std::nullopt;
  }
  Topology topology;
  topology.entities.resize(parts.num_entities);
  topology.interfaces.resize(parts.num_interfaces);
  topology.pads.resize(parts.num_pads);
  topology.links.resize(parts.num_links);
  parts.ptr_entities = reinterpret_cast<std::uintptr_t>(topology.entities.data());
  parts.ptr_interfaces = reinterpret_cast<std::uintptr_t>(topology.interfaces.data());
  parts.ptr_pads = reinterpret_cast<std::uintptr_t>(topology.pads.data());
  parts.ptr_links = reinterpret_cast<std::uintptr_t>(topology.links.data());
  // Refused where parts have come since they were counted.
  if (media.control(MEDIA_IOC_G_TOPOLOGY, &parts) < 0) return std::nullopt;
  return topology;
}

bool isInterfaceLink(const media_v2_link& link) {
  return (link.flags & MEDIA_LNK_FL_LINK_TYPE) == MEDIA_LNK_FL_INTERFACE_LINK;
}

bool isEnabledDataLink(const media_v2_link& link) {
  return (link.flags & MEDIA_LNK_FL_LINK_TYPE) == MEDIA_LNK_FL_DATA_LINK && (link.flags & MEDIA_LNK_FL_ENABLED) != 0;
}

template <typename Part>
const Part* find(const std::vector<Part>& parts, std::uint32_t id) {
  const auto found = std::find_if(parts.begin(), parts.end(), [&](const Part& part) { return part.id == id; });
  return found == parts.end() ? nullptr : &*found;
}

// The entity that a device file is of; 0 where it is of none of this media device.
std::uint32_t entityOf(const Topology& topology, std::uint64_t device_number) {
  for (const media_v2_interface& interface : topology.interfaces) {
    if (makedev(interface.devnode.major, interface.devnode.minor) != device_number) continue;
    for (const media_v2_link& link : topology.links) {
      if (isInterfaceLink(link) && link.source_id == interface.id) return link.sink_id;
    }
  }
  return 0;
}

// Where the kernel's device files are, whatever udev calls them otherwise. Empty where the entity has none.
std::string deviceFileOf(const Topology& topology, std::uint32_t entity) {
  for (const media_v2_link& link : topology.links) {
    if (!isInterfaceLink(link) || link.sink_id != entity) continue;
    const media_v2_interface* const interface = find(topology.interfaces, link.source_id);
    if (interface == nullptr || interface->intf_type != MEDIA_INTF_T_V4L_SUBDEV) continue;
    return "/dev/char/" + std::to_string(interface->devnode.major) + ":" + std::to_string(interface->devnode.minor);
  }
  return "";
}

// The pads by which images leave the sensors that an entity's images come from.
std::vector<media_v2_pad> sensorPads(const Topology& topology, std::uint32_t entity) {
  std::vector<std::uint32_t> reached{entity};
  std::vector<media_v2_pad> sensors;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    for (const media_v2_link& link : topology.links) {
      if (!isEnabledDataLink(link)) continue;
      const media_v2_pad* const sink = find(topology.pads, link.sink_id);
      const media_v2_pad* const source = find(topology.pads, link.source_id);
      if (sink == nullptr || source == nullptr || sink->entity_id != reached[i]) continue;
      const std::uint32_t before = source->entity_id;
      if (std::find(reached.begin(), reached.end(), before) != reached.end()) continue;
      reached.push_back(before);
      const media_v2_entity* const found = find(topology.entities, before);
      if (found != nullptr && found->function == MEDIA_ENT_F_CAM_SENSOR) sensors.push_back(*source);
    }
  }
  return sensors;
}

}  // namespace

std::optional<SensorDevice> openSensor(const CaptureDevice& device) {
  SystemCalls& system = device.device.system();
  const std::uint64_t video_number = system.deviceNumber(device.device.descriptor());
  for (int i = 0; video_number != 0 && i < most_media_devices; ++i) {
    const int media_file = system.openFile(("/dev/media" + std::to_string(i)).c_str());
    if (media_file < 0) continue;
    const Device media(system, media_file);
    const std::optional<Topology> topology = topologyOf(media);
    const std::uint32_t video = topology ? entityOf(*topology, video_number) : 0;
    if (video == 0) continue;
    const std::vector<media_v2_pad> pads = sensorPads(*topology, video);
    if (pads.size() != 1) return std::nullopt;
    const std::string path = deviceFileOf(*topology, pads[0].entity_id);
    const int sensor_file = path.empty() ? -1 : system.openFile(path.c_str());
    if (sensor_file < 0) return std::nullopt;
    return SensorDevice{Device(system, sensor_file), pads[0].index};
  }
  return std::nullopt;
}

}  // namespace edgeslam
