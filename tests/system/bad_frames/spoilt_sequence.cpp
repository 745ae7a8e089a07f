#include "system/bad_frames/spoilt_sequence.h"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <stdexcept>

namespace edgeslam {
namespace {

struct Line {
  std::string time, rest;
};

std::vector<Line> linesOf(const std::string& path) {
  std::vector<Line> lines;
  std::istringstream text(fileContent(path));
  for (std::string line; std::getline(text, line);) {
    if (line.empty() || line[0] == '#') continue;
    const std::size_t space = line.find(' ');
    lines.push_back({line.substr(0, space), line.substr(space + 1)});
  }
  if (lines.empty()) throw std::runtime_error(path + " is missing: these tests need ctest's fixtures, which make it");
  return lines;
}

}  // namespace

SpoiltSequence::SpoiltSequence(const std::string& folder, int count) : folder_(folder) {
  const std::vector<Line> pictures = linesOf(folder + "/rgb.txt"), poses = linesOf(folder + "/groundtruth.txt");
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    frames_.push_back({pictures.at(i).time, pictures.at(i).rest, poses.at(i).rest, {}, true});
  }
}

cv::Mat SpoiltSequence::original(int index) const {
  const std::string path = folder_ + "/" + frames_.at(static_cast<std::size_t>(index)).picture;
  const cv::Mat picture = cv::imread(path, cv::IMREAD_GRAYSCALE);
  if (picture.empty()) throw std::runtime_error(path + " cannot be read");
  return picture;
}

void SpoiltSequence::replace(int first, int last, const std::function<cv::Mat(int)>& spoil) {
  for (int i = first; i <= last; ++i) frames_.at(static_cast<std::size_t>(i)).spoilt = spoil(i);
}

void SpoiltSequence::repeat(int index, int of) {
  const Frame& again = frames_.at(static_cast<std::size_t>(of));
  Frame& frame = frames_.at(static_cast<std::size_t>(index));
  frame.picture = again.picture;
  frame.pose = again.pose;
}

void SpoiltSequence::drop(int index) { frames_.at(static_cast<std::size_t>(index)).comes = false; }

void SpoiltSequence::standStill(int first, int count, double interval_s) {
  const std::size_t begin = static_cast<std::size_t>(first), pictures = frames_.size() - begin;
  const double end_s = std::stod(frames_.back().time);
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    Frame frame = frames_.at(begin + i % pictures);
    frame.time = std::to_string(end_s + static_cast<double>(i + 1) * interval_s);
    frames_.push_back(std::move(frame));
  }
}

int SpoiltSequence::size() const {
  return static_cast<int>(
      std::count_if(frames_.begin(), frames_.end(), [](const Frame& frame) { return frame.comes; }));
}

std::string SpoiltSequence::write(const TemporaryFolder& folder, const std::string& name) const {
  std::string pictures, truth;
  folder.write(name + "/camera.yaml", fileContent(folder_ + "/camera.yaml"));
  std::filesystem::create_directory_symlink(folder_, folder.path(name + "/original"));
  for (const Frame& frame : frames_) {
    if (!frame.comes) continue;
    std::string picture = "original/" + frame.picture;
    if (!frame.spoilt.empty()) {
      picture = frame.time + ".pgm";
      if (!cv::imwrite(folder.path(name + "/" + picture), frame.spoilt)) throw std::runtime_error("disk full?");
    }
    pictures += frame.time + " " + picture + "\n";
    truth += frame.time + " " + frame.pose + "\n";
  }
  folder.write(name + "/rgb.txt", pictures);
  folder.write(name + "/groundtruth.txt", truth);
  return folder.path(name);
}

}  // namespace edgeslam
