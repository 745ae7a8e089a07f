// What a daemon is started with, and what follows from it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "configuration/configuration.h"
#include "drivers/lcm/start_check.h"
#include "drivers/viewer/viewer.h"
#include "map/map.h"
#include "service/publishing_setup.h"

namespace edgeslam {

struct DaemonSetup {
  Configuration configuration;
  Camera camera;
  CameraOptions capture;      // the configuration's, or a recording as a stand-in
  std::string record_folder;  // of a recording from the start; empty: none
  std::optional<Map> map_in;  // to be continued
  std::string map_out;        // empty: not written
  bool for_viewing = false;   // begins when someone looks on, and goes on after the end until a signal
};

// What the system must allow and have room for.
StartNeeds startNeeds(const DaemonSetup& setup);

// `viewer` may be null.
PublishingSetup publishingSetup(const DaemonSetup& setup, Viewer* viewer);

// Those that can be carried out at all.
std::vector<std::string> commandsOf(const DaemonSetup& setup);

}  // namespace edgeslam
