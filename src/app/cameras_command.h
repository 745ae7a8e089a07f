// `edgeslam cameras`: the cameras that are there, what they offer, and the configuration lines to use them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "drivers/libcamera/libcamera_camera.h"
#include "drivers/v4l2/device_list.h"

namespace CLI {
class App;
}

namespace edgeslam {

// Adds the subcommand; `exit_code` and `app` must outlive the parsing.
void addCamerasCommand(CLI::App& app, int& exit_code);

// What it prints, as text and as JSON.
std::string camerasText(const std::vector<ListedCamera>& cameras, const LibcameraListing& libcameras);
nlohmann::json camerasJson(const std::vector<ListedCamera>& cameras, const LibcameraListing& libcameras);

}  // namespace edgeslam
