#include "service/publishing_setup.h"

namespace edgeslam {

PublishingSetup publishingSetup(const Configuration& configuration, const Camera& camera) {
  const ServiceOptions& service = configuration.service;
  PublishingSetup setup;
  setup.lcm = service.lcm;
  setup.lcm.real_time_priority = configuration.settings.threads.publishing_priority;
  setup.ros2 = service.ros2;
  setup.map_interval_s = service.map_interval_s;
  setup.body_T_camera = configuration.body_T_camera;
  setup.camera = camera;
  setup.scale = service.scale;
  setup.map_is_frozen = configuration.settings.tracking.map_is_frozen;
  const bool is_motion = configuration.settings.tracking.wheels.has_value();  // the map's own scale counts then
  if (service.scale.source == "odometry" && is_motion) setup.scale.source = "none";
  if (setup.scale.source == "odometry") setup.lcm.wheels_channel = service.scale.odometry.channel;
  return setup;
}

}  // namespace edgeslam
