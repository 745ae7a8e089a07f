// Sequences put together from the frames of others, as a film is cut: in another order, with something before the lens,
// with frames missing. No image is copied.
#pragma once

#include <array>
#include <cstdio>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "system/program.h"

namespace edgeslam {

class EditedSequence {
 public:
  explicit EditedSequence(double start_s = 1000, double fps = 30) : time_s_(start_s), step_s_(1 / fps) {}

  // Frames `first` to `last`, both of them, of a simulated sequence of 320 x 240 pixels; backwards where `last` comes
  // before `first`.
  EditedSequence& add(const std::string& folder, int first, int last) {
    const Source& source = sourceOf(folder);
    for (int i = first;; i += last < first ? -1 : 1) {
      const auto frame = static_cast<std::size_t>(i);
      addFrame(source.link + "/" + afterTime(source.images.at(frame)), afterTime(source.truth.at(frame)));
      if (i == last) return *this;
    }
  }
  // Black frames; the camera stands still meanwhile.
  EditedSequence& addBlack(int count) {
    for (int i = 0; i < count; ++i) addFrame("black.pgm", frames_.back().pose);
    return *this;
  }
  // So much time in which no frame comes.
  EditedSequence& wait(double seconds) {
    time_s_ += seconds;
    return *this;
  }

  int size() const { return static_cast<int>(frames_.size()); }

  // In TUM layout, with ground truth. `name`: of the folder to make in `folder`. Returns its path.
  std::string write(const TemporaryFolder& folder, const std::string& name) const {
    folder.write(name + "/black.pgm", "P5\n320 240\n255\n" + std::string(320 * 240, '\0'));
    std::string images, truth;
    for (const EditedFrame& frame : frames_) {
      std::array<char, 32> time{};
      std::snprintf(time.data(), time.size(), "%.6f ", frame.time_s);
      images += time.data() + frame.image + "\n";
      truth += time.data() + frame.pose + "\n";
    }
    folder.write(name + "/rgb.txt", images);
    folder.write(name + "/groundtruth.txt", truth);
    for (const auto& [path, source] : sources_) {
      std::filesystem::create_directory_symlink(path, folder.path(name + "/" + source.link));
    }
    folder.write(name + "/camera.yaml", fileContent(sources_.begin()->first + "/camera.yaml"));
    return folder.path(name);
  }

 private:
  struct Source {
    std::string link;  // in the folder that is written
    std::vector<std::string> images, truth;
  };
  struct EditedFrame {
    double time_s = 0;
    std::string image, pose;
  };

  const Source& sourceOf(const std::string& folder) {
    const auto [found, added] = sources_.try_emplace(folder);
    if (!added) return found->second;
    found->second.link = "source" + std::to_string(sources_.size());
    found->second.images = linesOf(folder + "/rgb.txt");
    found->second.truth = linesOf(folder + "/groundtruth.txt");
    return found->second;
  }
  static std::vector<std::string> linesOf(const std::string& path) {
    std::vector<std::string> lines;
    std::istringstream text(fileContent(path));
    for (std::string line; std::getline(text, line);) {
      if (!line.empty() && line[0] != '#') lines.push_back(line);
    }
    if (lines.empty()) throw std::runtime_error(path + " is missing: these tests need ctest's fixtures, which make it");
    return lines;
  }
  static std::string afterTime(const std::string& line) { return line.substr(line.find(' ') + 1); }
  void addFrame(const std::string& image, const std::string& pose) {
    frames_.push_back({time_s_, image, pose});
    time_s_ += step_s_;
  }

  double time_s_, step_s_;
  std::map<std::string, Source> sources_;
  std::vector<EditedFrame> frames_;
};

}  // namespace edgeslam
