#include "app/cameras_command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/command_line.h"
#include "configuration/configuration.h"
#include "configuration/configuration_capture.h"
#include "files/format_text.h"

namespace edgeslam {
namespace {

constexpr std::size_t most_sizes_shown = 40;

void indent(std::string& text, const std::string& line, int depth) {
  text.append(static_cast<std::size_t>(2 * depth), ' ').append(line).append("\n");
}

std::string controlText(const CameraControl& control) {
  std::string text = control.name + ": " + (control.has_value ? std::to_string(control.value) : "(write only)") + " (" +
                     allowedValues(control) + ", usually " + std::to_string(control.usual);
  if (control.read_only) text += ", read only";
  if (control.inactive) text += ", inactive while its automatic is on";
  return text + ")";
}

void appendConfiguration(std::string& text, const CameraOptions& options) {
  indent(text, "in the configuration:", 1);
  std::string line;
  for (const char c : formatCaptureSection(options)) {
    if (c != '\n') {
      line += c;
      continue;
    }
    indent(text, line, 2);
    line.clear();
  }
}

// The first format, size and rate that would be taken.
CameraOptions optionsFor(const ListedCamera& camera) {
  CameraOptions options;
  options.device = camera.stableName();
  for (const PixelFormat known : pixel_formats) {
    for (const OfferedFormat& format : camera.formats) {
      if (format.format != known || format.sizes.empty()) continue;
      options.format = format.name;
      const auto usual = std::find_if(format.sizes.begin(), format.sizes.end(),
                                      [](const OfferedSize& size) { return size.holds(640, 480); });
      const OfferedSize& size = usual != format.sizes.end() ? *usual : format.sizes.front();
      options.width = usual != format.sizes.end() ? 640 : size.largest_width;
      options.height = usual != format.sizes.end() ? 480 : size.largest_height;
      return options;
    }
  }
  return options;
}

void appendCamera(std::string& text, const ListedCamera& camera) {
  text += camera.stableName() + "\n";
  if (camera.path != camera.stableName()) indent(text, "now " + camera.path, 1);
  if (!camera.problem.empty()) return indent(text, camera.problem, 1);
  indent(text, camera.card + ", driver " + camera.driver + ", at " + camera.bus, 1);
  if (camera.sensor) {
    indent(text,
           formatted(
               "its sensor now gives %d x %d px and reads the rows over %.1f ms; for a rolling shutter, and images "
               "of all these rows: camera.readout: %.4f",
               camera.sensor->width, camera.sensor->height, 1e3 * camera.sensor->readout_s, camera.sensor->readout_s),
           1);
  }
  indent(text, "formats:", 1);
  for (const OfferedFormat& format : camera.formats) {
    if (format.format) {
      indent(text, listFormat(format), 2);
    } else {
      indent(text, format.name + " (cannot be used)", 2);
    }
  }
  if (!camera.controls.empty()) indent(text, "controls:", 1);
  for (const CameraControl& control : camera.controls) indent(text, controlText(control), 2);
  appendConfiguration(text, optionsFor(camera));
}

void appendCamera(std::string& text, const ListedLibcamera& camera) {
  CameraOptions options;
  options.device = libcamera_prefix + camera.name;
  text += options.device + "\n";
  if (!camera.model.empty()) indent(text, camera.model, 1);
  if (!camera.problem.empty()) return indent(text, camera.problem, 1);
  indent(text, "formats:", 1);
  for (const LibcameraFormat& format : camera.formats) {
    std::string line = format.name + (format.known ? "" : " (cannot be used)");
    for (std::size_t i = 0; format.known && i < std::min(format.sizes.size(), most_sizes_shown); ++i) {
      line += (i == 0 ? " " : ", ") + std::to_string(format.sizes[i].width) + " x " +
              std::to_string(format.sizes[i].height);
    }
    indent(text, line, 2);
  }
  if (!camera.controls.empty()) indent(text, "controls:", 1);
  for (const LibcameraControl& control : camera.controls) indent(text, control.name + ": " + control.allowed, 2);
  appendConfiguration(text, options);
}

nlohmann::json sizeJson(const OfferedSize& size) {
  return {{"width", {size.least_width, size.largest_width, size.width_step}},
          {"height", {size.least_height, size.largest_height, size.height_step}},
          {"frame_rates", size.rates}};
}

nlohmann::json controlJson(const CameraControl& control) {
  nlohmann::json json{{"name", control.name},         {"least", control.least},
                      {"largest", control.largest},   {"step", control.step},
                      {"default", control.usual},     {"read_only", control.read_only},
                      {"inactive", control.inactive}, {"choices", nlohmann::json::object()}};
  if (control.has_value) json["value"] = control.value;
  for (const ControlChoice& choice : control.choices) json["choices"][std::to_string(choice.value)] = choice.name;
  return json;
}

}  // namespace

std::string camerasText(const std::vector<ListedCamera>& cameras, const LibcameraListing& libcameras) {
  std::string text;
  for (const ListedCamera& camera : cameras) appendCamera(text, camera);
  for (const ListedLibcamera& camera : libcameras.cameras) appendCamera(text, camera);
  if (text.empty()) text = "no camera is there\n";
  if (!libcameras.problem.empty()) text += "libcamera: " + libcameras.problem + "\n";
  return text;
}

nlohmann::json camerasJson(const std::vector<ListedCamera>& cameras, const LibcameraListing& libcameras) {
  nlohmann::json json{{"cameras", nlohmann::json::array()},
                      {"libcamera", {{"version", libcameras.version}, {"problem", libcameras.problem}}}};
  for (const ListedCamera& camera : cameras) {
    nlohmann::json formats = nlohmann::json::array(), controls = nlohmann::json::array();
    for (const OfferedFormat& format : camera.formats) {
      nlohmann::json sizes = nlohmann::json::array();
      for (const OfferedSize& size : format.sizes) sizes.push_back(sizeJson(size));
      formats.push_back({{"name", format.name}, {"usable", format.format.has_value()}, {"sizes", sizes}});
    }
    for (const CameraControl& control : camera.controls) controls.push_back(controlJson(control));
    json["cameras"].push_back({{"device", camera.stableName()},
                               {"path", camera.path},
                               {"by_id", camera.by_id},
                               {"by_path", camera.by_path},
                               {"name", camera.card},
                               {"driver", camera.driver},
                               {"bus", camera.bus},
                               {"problem", camera.problem},
                               {"formats", formats},
                               {"controls", controls}});
    if (!camera.sensor) continue;
    json["cameras"].back()["sensor"] = {
        {"width", camera.sensor->width}, {"height", camera.sensor->height}, {"readout_s", camera.sensor->readout_s}};
  }
  for (const ListedLibcamera& camera : libcameras.cameras) {
    nlohmann::json formats = nlohmann::json::array(), controls = nlohmann::json::array();
    for (const LibcameraFormat& format : camera.formats) {
      nlohmann::json sizes = nlohmann::json::array();
      for (const cv::Size& size : format.sizes) sizes.push_back({{"width", size.width}, {"height", size.height}});
      formats.push_back({{"name", format.name}, {"usable", format.known}, {"sizes", sizes}});
    }
    for (const LibcameraControl& control : camera.controls) {
      controls.push_back({{"name", control.name}, {"allowed", control.allowed}});
    }
    json["cameras"].push_back({{"device", libcamera_prefix + camera.name},
                               {"name", camera.model},
                               {"driver", "libcamera"},
                               {"problem", camera.problem},
                               {"formats", formats},
                               {"controls", controls}});
  }
  return json;
}

void addCamerasCommand(CLI::App& app, int& exit_code) {
  const auto json = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand("cameras", "List the cameras, what they offer, and how to configure them");
  command->add_flag("--json", *json, "Print JSON");
  command->callback([json, &exit_code] {
    const std::vector<ListedCamera> cameras = listV4l2Cameras();
    const LibcameraListing libcameras = listLibcameras();
    if (*json) {
      // What a driver calls itself need not be UTF-8.
      std::cout << camerasJson(cameras, libcameras).dump(2, ' ', false, nlohmann::json::error_handler_t::replace)
                << "\n";
    } else {
      std::cout << camerasText(cameras, libcameras);
    }
    exit_code = exit_done;
  });
}

}  // namespace edgeslam
