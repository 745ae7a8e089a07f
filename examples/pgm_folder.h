// What the examples take for a camera: a folder of PGM images (P5, 8 bits), named by their time stamp [s].
#pragma once

#include <edgeslam/input_error.h>
#include <edgeslam/types.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

struct PgmImage {
  int width = 0, height = 0;  // [px]
  std::vector<std::uint8_t> pixels;

  edgeslam::GreyImage view() const { return {pixels.data(), width, height, width}; }
};

// Throws edgeslam::InputError where the file cannot be used.
inline PgmImage readPgm(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string kind;
  int largest = 0;
  PgmImage image;
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

struct TimedFile {
  std::int64_t time_ns = 0;
  std::filesystem::path path;
};

// In the order of their times.
inline std::vector<TimedFile> pgmFiles(const std::filesystem::path& folder) {
  std::vector<TimedFile> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::filesystem::path& path = entry.path();
    if (path.extension() != ".pgm") continue;
    files.push_back({static_cast<std::int64_t>(std::stod(path.stem().string()) * 1e9), path});
  }
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) { return a.time_ns < b.time_ns; });
  return files;
}
