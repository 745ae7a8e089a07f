// A map is made and saved. Then a second run, from anywhere in it, finds its place and goes on in the same world.
//
//     3_saved_map CONFIGURATION FIRST_FOLDER MAP SECOND_FOLDER
#include <edgeslam/slam.h>

#include <cstdio>

#include "pgm_folder.h"

namespace {

void makeMap(const char* configuration, const char* folder, const char* map) {
  edgeslam::Slam slam(configuration);
  for (const TimedFile& file : pgmFiles(folder)) slam.process(readPgm(file.path).view(), file.time_ns);
  slam.finish();
  slam.saveMap(map);  // whole or not at all
  std::printf("%s: %zu keyframes, %zu points\n", map, slam.keyframes().size(), slam.map().size());
}

void goOn(const char* configuration, const char* map, const char* folder) {
  edgeslam::Slam slam(configuration);
  slam.goOnWith(map);  // before the first frame; with the calibration that the map was made with
  bool found = false;
  for (const TimedFile& file : pgmFiles(folder)) {
    const edgeslam::PosedFrame frame = slam.process(readPgm(file.path).view(), file.time_ns);
    if (frame.isGood() && !found) {
      const auto& p = frame.pose.position;
      std::printf("frame %lld: found in the map at %.3f %.3f %.3f\n", static_cast<long long>(frame.index), p[0], p[1],
                  p[2]);
      found = true;
    }
    for (const std::string& event : slam.takeEvents()) std::printf("%s\n", event.c_str());
  }
  if (!found) std::printf("not found in the map\n");
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 5) throw edgeslam::InputError("usage: 3_saved_map CONFIGURATION FIRST_FOLDER MAP SECOND_FOLDER");
  makeMap(argv[1], argv[2], argv[3]);
  goOn(argv[1], argv[3], argv[4]);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "3_saved_map: %s\n", error.what());
  return 2;
}
