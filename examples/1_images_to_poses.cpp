// Images in, poses out: a trajectory in TUM format, in the caller's thread. The same images give the same poses.
//
//     1_images_to_poses CONFIGURATION FOLDER > trajectory.txt
#include <edgeslam/slam.h>

#include <cstdio>

#include "pgm_folder.h"

namespace {

void track(const char* configuration, const char* folder) {
  edgeslam::Slam slam(configuration);
  for (const TimedFile& file : pgmFiles(folder)) {
    const PgmImage image = readPgm(file.path);
    const edgeslam::PosedFrame frame = slam.process(image.view(), file.time_ns);
    // A robot would steer by frame.pose now, if it is good. Here only what is not good is told.
    if (!frame.isGood()) std::fprintf(stderr, "%s: %s\n", file.path.c_str(), frame.reason.c_str());
  }
  // At the end loops are closed, and every frame that had a good pose gets its final one.
  for (const edgeslam::TimedCameraPose& timed : slam.finish()) {
    const auto& p = timed.pose.position;
    const auto& q = timed.pose.orientation;  // w first; TUM files have it last
    std::printf("%.9f %.9g %.9g %.9g %.9g %.9g %.9g %.9g\n", 1e-9 * static_cast<double>(timed.time_ns), p[0], p[1],
                p[2], q[1], q[2], q[3], q[0]);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: 1_images_to_poses CONFIGURATION FOLDER > trajectory.txt\n");
    return 2;
  }
  try {
    track(argv[1], argv[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "1_images_to_poses: %s\n", error.what());
    return 2;
  }
  return 0;
}
