// Poses for images in a folder, by the installed library alone: PGM files (P5, 8 bits), named by their time stamp [s],
// in order.
//
//     track_images CONFIGURATION FOLDER > trajectory.txt
#include <edgeslam/slam.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <vector>

namespace {

struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;
};

Image readPgm(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string kind;
  int largest = 0;
  Image image;
  file >> kind >> image.width >> image.height >> largest;
  file.get();
  if (!file || kind != "P5" || largest != 255 || image.width < 1 || image.height < 1 || image.width > 16384 ||
      image.height > 16384) {
    throw edgeslam::InputError(path.string() + ": expected a PGM image (P5, 8 bits)");
  }
  image.pixels.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  if (!file.read(reinterpret_cast<char*>(image.pixels.data()), static_cast<std::streamsize>(image.pixels.size()))) {
    throw edgeslam::InputError(path.string() + ": is cut short");
  }
  return image;
}

std::int64_t timeOf(const std::filesystem::path& path) {
  return static_cast<std::int64_t>(std::stod(path.stem().string()) * 1e9);
}

void track(const char* configuration, const char* folder) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".pgm") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end(), [](const auto& a, const auto& b) { return timeOf(a) < timeOf(b); });

  edgeslam::Slam slam(configuration);
  for (const auto& path : paths) {
    const Image image = readPgm(path);
    const edgeslam::PosedFrame frame =
        slam.process({image.pixels.data(), image.width, image.height, image.width}, timeOf(path));
    if (!frame.isGood()) std::fprintf(stderr, "%s: %s\n", path.c_str(), frame.reason.c_str());
  }
  for (const edgeslam::TimedCameraPose& pose : slam.finish()) {
    const auto& p = pose.pose.position;
    const auto& q = pose.pose.orientation;
    std::printf("%.9f %.9g %.9g %.9g %.9g %.9g %.9g %.9g\n", 1e-9 * static_cast<double>(pose.time_ns), p[0], p[1], p[2],
                q[1], q[2], q[3], q[0]);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: track_images CONFIGURATION FOLDER > trajectory.txt\n");
    return 2;
  }
  try {
    track(argv[1], argv[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "track_images: %s\n", error.what());
    return 2;
  }
  return 0;
}
