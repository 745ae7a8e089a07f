#include "frames/video_source.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "files/text_file.h"
#include "frames/image_file.h"
#include "frames/video_decoder.h"

namespace edgeslam {
namespace {

std::vector<std::int64_t> readTimes(const std::string& path) {
  std::vector<std::int64_t> times;
  for (const TextLine& line : readTextLines(path)) {
    const std::vector<std::string_view> columns = splitColumns(line.text);
    const std::optional<std::int64_t> time = columns.empty() ? std::nullopt : parseStamp(columns[0]);
    if (!time) throw InputError(placeInFile(path, line.number) + "'" + line.text + "' is not a time stamp [s]");
    if (!times.empty() && *time <= times.back()) {
      throw InputError(placeInFile(path, line.number) + "the time stamp " + formatStamp(*time) + " s " +
                       (*time == times.back() ? "is the same as" : "lies before") + " the one before (" +
                       formatStamp(times.back()) + " s); time stamps must increase");
    }
    times.push_back(*time);
  }
  if (times.empty()) throw InputError(path + ": holds no time stamps; expected one [s] a line for each frame");
  return times;
}

// Pictures of a video, in order, checked and grey.
class VideoPictures {
 public:
  VideoPictures(const std::string& path, const FrameCompanions& companions) : path_(path) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) throw InputError(path + ": no such video file");
    decoder_ = openVideo(path);
    if (companions.camera) {
      expected_size_ = {companions.camera->width, companions.camera->height};
      expected_by_ = companions.camera_path + " says";
    }
  }

  // False at the end of the video.
  bool advance() { return decoder_->advance(); }

  // Puts the current picture, or what is wrong with it, into the frame.
  void decodeInto(Frame& frame) {
    const VideoPicture picture = decoder_->picture();
    const std::string place = path_ + ": frame " + std::to_string(frame.index) + " ";
    if (picture.pixels == nullptr) {
      frame.problem = place + "cannot be decoded";
      return;
    }
    const cv::Size size(picture.width, picture.height);
    const std::string problem = sizeProblem(size, expected_size_, expected_by_);
    if (!problem.empty()) {
      frame.problem = place + problem;
      return;
    }
    if (expected_size_.empty()) {
      expected_size_ = size;
      expected_by_ = "those before are";
    }
    const cv::Mat colour(size, CV_8UC3, const_cast<unsigned char*>(picture.pixels), picture.stride);
    cv::cvtColor(colour, frame.grey, cv::COLOR_BGR2GRAY);
  }

  const VideoDecoder& decoder() const { return *decoder_; }

 private:
  std::string path_;
  std::unique_ptr<VideoDecoder> decoder_;
  cv::Size expected_size_;
  std::string expected_by_;
};

class StampedVideoSource : public FrameSource {
 public:
  StampedVideoSource(std::string video_path, std::string times_path, FrameCompanions companions)
      : video_path_(std::move(video_path)),
        times_path_(std::move(times_path)),
        companions_(std::move(companions)),
        times_(readTimes(times_path_)),
        pictures_(video_path_, companions_) {}

  std::optional<Frame> next() override {
    if (!pictures_.advance()) {
      if (next_ < times_.size()) failOnCounts(next_);
      return std::nullopt;
    }
    if (next_ >= times_.size()) {
      std::size_t pictures = next_ + 1;
      while (pictures_.advance()) ++pictures;
      failOnCounts(pictures);
    }
    Frame frame;
    frame.index = static_cast<std::int64_t>(next_);
    frame.time_ns = times_[next_++];
    pictures_.decodeInto(frame);
    return frame;
  }

  std::int64_t size() const override { return static_cast<std::int64_t>(times_.size()); }
  std::string kind() const override { return "video with times.txt"; }
  std::optional<Camera> camera() const override { return companions_.camera; }
  std::string groundTruthPath() const override { return companions_.ground_truth_path; }
  InertialFiles inertialFiles() const override { return companions_.inertial_files; }
  std::string wheelOdometryPath() const override { return companions_.wheel_odometry_path; }

 private:
  [[noreturn]] void failOnCounts(std::size_t pictures) const {
    const std::string difference =
        pictures < times_.size()
            ? std::to_string(times_.size() - pictures) + " frames are missing (is the video cut off?)"
            : std::to_string(pictures - times_.size()) + " time stamps are missing";
    throw InputError(video_path_ + ": holds " + std::to_string(pictures) + " frames, " + times_path_ + " " +
                     std::to_string(times_.size()) + " time stamps: " + difference);
  }

  std::string video_path_;
  std::string times_path_;
  FrameCompanions companions_;
  std::vector<std::int64_t> times_;
  VideoPictures pictures_;
  std::size_t next_ = 0;
};

class VideoSource : public FrameSource {
 public:
  VideoSource(const std::string& video_path, FrameCompanions companions)
      : video_path_(video_path), companions_(std::move(companions)), pictures_(video_path, companions_) {}

  std::optional<Frame> next() override {
    if (!pictures_.advance()) {
      if (next_ == 0) throw InputError(video_path_ + ": holds no frame that can be decoded");
      return std::nullopt;
    }
    Frame frame;
    frame.index = next_++;
    frame.time_ns = timeOfCurrent(frame.index);
    previous_time_ns_ = frame.time_ns;
    pictures_.decodeInto(frame);
    return frame;
  }

  std::int64_t size() const override {
    const double count = pictures_.decoder().frameCount();
    return std::isfinite(count) && count > 0 && count < 1e9 ? static_cast<std::int64_t>(count) : 0;
  }
  std::string kind() const override { return "video"; }
  cv::Size videoSize() const override { return {pictures_.decoder().width(), pictures_.decoder().height()}; }
  std::optional<Camera> camera() const override { return companions_.camera; }
  std::string groundTruthPath() const override { return companions_.ground_truth_path; }
  InertialFiles inertialFiles() const override { return companions_.inertial_files; }
  std::string wheelOdometryPath() const override { return companions_.wheel_odometry_path; }

 private:
  std::int64_t timeOfCurrent(std::int64_t index) const {
    const double position_ns = 1e6 * pictures_.decoder().positionMilliseconds();
    if (std::isfinite(position_ns) && position_ns >= 0 && position_ns < 1e18) {
      const std::int64_t time_ns = std::llround(position_ns);
      if (index == 0 || time_ns > previous_time_ns_) return time_ns;
    }
    const double rate = pictures_.decoder().framesPerSecond();
    if (!(rate > 0 && rate < 1e6)) {
      throw InputError(video_path_ + ": has neither frame times that increase nor a frame rate; put it into a folder " +
                       "with a times.txt of one time stamp [s] a line");
    }
    return index == 0 ? 0 : previous_time_ns_ + std::llround(1e9 / rate);
  }

  std::string video_path_;
  FrameCompanions companions_;
  VideoPictures pictures_;
  std::int64_t next_ = 0;
  std::int64_t previous_time_ns_ = 0;
};

}  // namespace

bool isVideoFileName(const std::string& name) {
  constexpr std::array<const char*, 12> extensions{".wmv", ".mpeg", ".mjpeg", ".mp4", ".mkv", ".avi",
                                                   ".mov", ".webm", ".m4v",   ".ts",  ".mpg", ".h264"};
  std::string extension = std::filesystem::path(name).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return name.front() != '.' && std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

std::unique_ptr<FrameSource> makeStampedVideoSource(const std::string& video_path, const std::string& times_path,
                                                    FrameCompanions companions) {
  return std::make_unique<StampedVideoSource>(video_path, times_path, std::move(companions));
}

std::unique_ptr<FrameSource> makeVideoSource(const std::string& video_path, FrameCompanions companions) {
  return std::make_unique<VideoSource>(video_path, std::move(companions));
}

}  // namespace edgeslam
