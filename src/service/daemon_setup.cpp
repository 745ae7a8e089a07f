#include "service/daemon_setup.h"

#include <algorithm>
#include <filesystem>

namespace edgeslam {

StartNeeds startNeeds(const DaemonSetup& setup) {
  const ServiceOptions& service = setup.configuration.service;
  const ThreadOptions& threads = setup.configuration.settings.threads;
  StartNeeds needs;
  needs.lcm_url = effectiveUrl(service.lcm);
  needs.real_time_priority =
      std::max({threads.capture_priority, threads.tracking_priority, threads.publishing_priority});
  needs.lock_memory = threads.lock_memory;
  needs.folder = service.recordings_folder;
  if (needs.folder.empty() && !setup.map_out.empty()) {
    needs.folder = std::filesystem::absolute(setup.map_out).parent_path().string();
  }
  return needs;
}

PublishingSetup publishingSetup(const DaemonSetup& setup, Viewer* viewer) {
  PublishingSetup publishing = publishingSetup(setup.configuration, setup.camera);
  publishing.viewer = viewer;
  publishing.map_file = setup.map_out;
  publishing.begins_anew = true;
  if (setup.configuration.inertia.is_used) publishing.lcm.imu_channel = setup.configuration.inertia.channel;
  if (setup.configuration.settings.wheels.enabled) {
    publishing.lcm.wheels_channel = setup.configuration.service.scale.odometry.channel;
  }
  return publishing;
}

std::vector<std::string> commandsOf(const DaemonSetup& setup) {
  const ServiceOptions& service = setup.configuration.service;
  std::vector<std::string> commands{"reset", "set_scale"};
  if (!setup.map_out.empty()) commands.emplace_back("save_map");
  if (!service.recordings_folder.empty()) commands.insert(commands.end(), {"start_recording", "stop_recording"});
  if (!setup.for_viewing) commands.emplace_back("send_map");
  return commands;
}

}  // namespace edgeslam
