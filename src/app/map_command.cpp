#include "app/map_command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "app/command_line.h"
#include "app/map_info.h"
#include "app/map_part_text.h"
#include "app/output_file.h"
#include "configuration/configuration.h"
#include "edgeslam/input_error.h"
#include "files/atomic_file.h"
#include "files/format_text.h"
#include "image_formats/png.h"
#include "map/map_figures.h"
#include "map/saved_map.h"
#include "map/worlds.h"
#include "pipeline/map_joining.h"
#include "report/map_picture.h"

namespace edgeslam {
namespace {

struct InfoArguments {
  std::vector<std::string> files;
  std::string picture;
  bool json = false, force = false;
};

struct JoinArguments {
  std::vector<std::string> files;
  std::string output, configuration;
  bool force = false;
};

struct CropArguments {
  std::string file, output, kept_box;
  std::vector<std::string> removed_boxes, removed_keyframes;
  std::vector<int> removed_maps;
  int map = -1;  // that the boxes are in; -1: the only one
  bool force = false;
};

std::string inWords(const Map& map) {
  const std::vector<WorldFigures> worlds = figuresOf(map);
  std::size_t lines = 0;
  for (const WorldFigures& world : worlds) lines += world.lines;
  return formatted("%zu keyframes, %zu points, %zu lines", map.keyframes.size(), map.points.size(), lines) +
         (worlds.size() > 1 ? formatted(", in %zu maps that are not joined", worlds.size()) : "");
}

void writePicture(const std::string& path, const Map& map) {
  const std::vector<unsigned char> png = encodePng(drawMapFromAbove(map));
  writeFileAtomically(path, {reinterpret_cast<const char*>(png.data()), png.size()});
}

int tellInfo(const InfoArguments& arguments) {
  if (!arguments.picture.empty() && arguments.files.size() > 1) {
    throw InputError("--picture: is of one map, " + std::to_string(arguments.files.size()) + " are given");
  }
  if (!arguments.picture.empty()) refuseToReplace(arguments.picture, arguments.force);
  nlohmann::json all = nlohmann::json::array();
  for (const std::string& path : arguments.files) {
    const SavedMap saved = readMap(path);
    const std::uint64_t bytes = std::filesystem::file_size(path);
    if (arguments.json) {
      all.push_back(mapInfoJson(path, bytes, saved));
    } else {
      std::cout << mapInfoText(path, bytes, saved);
    }
    if (!arguments.picture.empty()) writePicture(arguments.picture, saved.map);
  }
  if (arguments.json) std::cout << all.dump(2) << "\n";
  return exit_done;
}

struct NamedMap {
  std::string path;
  Map map;
};

// The maps after the first, whose calibration `camera` gets.
std::vector<NamedMap> readMaps(const std::vector<std::string>& paths, Camera& camera) {
  std::vector<NamedMap> maps;
  for (const std::string& path : paths) {
    for (const NamedMap& other : maps) {
      std::error_code error;
      if (std::filesystem::equivalent(path, other.path, error)) throw InputError(path + ": is given twice");
    }
    SavedMap saved = readMap(path);
    if (maps.empty()) camera = saved.camera;
    if (const std::string difference = calibrationDifference(saved.camera, camera); !difference.empty()) {
      throw InputError(path + ": was made with another calibration than " + paths.front() + ": " + difference);
    }
    maps.push_back({path, std::move(saved.map)});
  }
  return maps;
}

std::string refusalOf(const std::string& path, const MapJoining& joining) {
  const std::string nearest = joining.nearest_loop.empty() ? "" : ", the nearest refused: " + joining.nearest_loop;
  const std::string figures = formatted(
      ": no place of it is found in the other maps: of %d keyframes of both %d are found in the other, of which %zu "
      "agree; of %d pairs that look alike %d are loops",
      joining.keyframes, joining.found, joining.agreeing, joining.alike, joining.loops);
  return path + figures + nearest;
}

std::string successOf(const std::string& path, const MapJoining& joining) {
  if (joining.loops > 0) return path + formatted(": joined by %d loops\n", joining.loops);
  return path + formatted(": joined: of %d keyframes of both %d are found in the other, of which %zu agree\n",
                          joining.keyframes, joining.found, joining.agreeing);
}

// Those that can be joined to what there is, in their order, until none is left; a map may lead to another one.
int joinMaps(const JoinArguments& arguments) {
  refuseToReplace(arguments.output, arguments.force);
  requireMapCanBeSaved(arguments.output);
  Configuration configuration;
  if (!arguments.configuration.empty()) configuration = readConfiguration(arguments.configuration);
  Camera camera;
  std::vector<NamedMap> waiting = readMaps(arguments.files, camera);
  if (const std::string wrong = maskProblem(camera, configuration); !wrong.empty()) {
    throw InputError(arguments.configuration + ": " + wrong);
  }
  camera.mask = configuration.mask;
  Map map = std::move(waiting.front().map);
  waiting.erase(waiting.begin());
  while (!waiting.empty()) {
    std::string refusal;
    bool any = false;
    for (auto added = waiting.begin(); added != waiting.end();) {
      const MapJoining joining = joinMap(camera, configuration.settings, added->map, map);
      if (joining.is_joined) {
        std::cout << successOf(added->path, joining);
        added = waiting.erase(added);
        any = true;
      } else {
        if (refusal.empty()) refusal = refusalOf(added->path, joining);
        ++added;
      }
    }
    if (any) continue;
    std::cerr << "edgeslam: " << refusal << "; " << arguments.output << " is not written\n";
    return exit_failed;
  }
  saveMap(arguments.output, camera, map);
  std::cout << arguments.output << ": " << inWords(map) << "\n";
  return exit_done;
}

MapCropping croppingOf(const CropArguments& arguments, const Map& map) {
  const std::vector<int> worlds = worldsOf(map);
  MapCropping cropping;
  const auto require = [&](int world) {
    if (std::binary_search(worlds.begin(), worlds.end(), world)) return;
    throw InputError(arguments.file + ": has no map " + std::to_string(world) + "; see `edgeslam map info`");
  };
  if (!arguments.kept_box.empty()) cropping.kept = parseMapBox(arguments.kept_box);
  for (const std::string& box : arguments.removed_boxes) cropping.removed_boxes.push_back(parseMapBox(box));
  const bool any_box = cropping.kept || !cropping.removed_boxes.empty();
  if (any_box && arguments.map < 0 && worlds.size() > 1) {
    throw InputError(arguments.file + ": has " + std::to_string(worlds.size()) +
                     " maps, each with coordinates of its own: say by --map which one the box is in");
  }
  cropping.world = arguments.map >= 0 ? arguments.map : worlds.front();
  require(cropping.world);
  for (const std::string& range : arguments.removed_keyframes) {
    cropping.removed_keyframes.push_back(parseKeyframeRange(range));
  }
  for (const int world : arguments.removed_maps) require(world);
  cropping.removed_worlds = arguments.removed_maps;
  if (!any_box && cropping.removed_keyframes.empty() && cropping.removed_worlds.empty()) {
    throw InputError("what is to be taken out? Give --keep-box, --remove-box, --remove-keyframes or --remove-map");
  }
  return cropping;
}

int cropMapFile(const CropArguments& arguments) {
  refuseToReplace(arguments.output, arguments.force);
  requireMapCanBeSaved(arguments.output);
  SavedMap saved = readMap(arguments.file);
  const RemovedParts removed = cropMap(croppingOf(arguments, saved.map), saved.map);
  if (removed.keyframes + removed.points + removed.lines == 0) {
    throw InputError(arguments.file + ": nothing of it lies there; `edgeslam map info` tells where it is");
  }
  if (saved.map.points.empty()) throw InputError(arguments.file + ": nothing would be left of it");
  saveMap(arguments.output, saved.camera, saved.map);
  std::cout << arguments.output << ": " << inWords(saved.map)
            << formatted("; %zu keyframes, %zu points and %zu lines are taken out\n", removed.keyframes, removed.points,
                         removed.lines);
  return exit_done;
}

void addInfo(CLI::App& map_command, int& exit_code) {
  const auto arguments = std::make_shared<InfoArguments>();
  CLI::App* command = map_command.add_subcommand("info", "What is in saved maps, and a picture of one from above");
  command->add_option("FILE", arguments->files, "Saved maps")->required();
  command->add_option("--picture", arguments->picture, "Picture of the map from above to write (PNG)");
  command->add_flag("--json", arguments->json, "For programs");
  command->add_flag("--force", arguments->force, "Replace the picture");
  command->callback([arguments, &exit_code] { exit_code = tellInfo(*arguments); });
}

void addJoin(CLI::App& map_command, int& exit_code) {
  const auto arguments = std::make_shared<JoinArguments>();
  CLI::App* command =
      map_command.add_subcommand("join", "Make one map of several of one place, by what they have seen both");
  command->add_option("FILE", arguments->files, "Saved maps of one camera; coordinates and unit are the first one's")
      ->required()
      ->expected(2, 1000);
  command->add_option("--output", arguments->output, "Map to write")->required();
  command->add_option("--config", arguments->configuration,
                      "Configuration (YAML) of the runs that made them: edges, loops and camera.mask count");
  command->add_flag("--force", arguments->force, "Replace the file");
  command->callback([arguments, &exit_code] { exit_code = joinMaps(*arguments); });
}

void addCrop(CLI::App& map_command, int& exit_code) {
  const auto arguments = std::make_shared<CropArguments>();
  CLI::App* command = map_command.add_subcommand("crop", "Take parts out of a saved map");
  command->add_option("FILE", arguments->file, "Saved map")->required();
  command->add_option("--output", arguments->output, "Map to write")->required();
  command->add_option("--keep-box", arguments->kept_box,
                      "Take out what lies outside of X:X,Y:Y,Z:Z [map units], as -1:2.5,:,0:");
  command->add_option("--remove-box", arguments->removed_boxes, "Take out what lies in a box; may be repeated")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option("--remove-keyframes", arguments->removed_keyframes, "Keyframes FIRST:LAST; may be repeated")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option("--remove-map", arguments->removed_maps, "One of several maps in the file; may be repeated")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option("--map", arguments->map, "The map that the boxes are in, where the file has several")
      ->check(CLI::NonNegativeNumber);
  command->add_flag("--force", arguments->force, "Replace the file");
  command->callback([arguments, &exit_code] { exit_code = cropMapFile(*arguments); });
}

}  // namespace

void addMapCommand(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("map", "Saved maps: what is in them, several made into one, parts taken out");
  command->require_subcommand(1);
  addInfo(*command, exit_code);
  addJoin(*command, exit_code);
  addCrop(*command, exit_code);
}

}  // namespace edgeslam
