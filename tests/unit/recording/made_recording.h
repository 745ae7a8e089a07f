// A recording made by hand, of frames that can be told apart.
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <map>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "recording/recording_source.h"
#include "recording/recording_writer.h"
#include "unit/files/temporary_folder.h"

namespace edgeslam {

constexpr int made_width = 32, made_height = 24;

inline RecordingDescription madeDescription() {
  RecordingDescription description;
  description.camera.width = made_width;
  description.camera.height = made_height;
  description.camera.fx = 30.1;
  description.camera.fy = 1e2 / 3;
  description.camera.cx = 15.7;
  description.camera.cy = 11.3;
  description.camera.distortion = {0.1, -0.2, 1.0 / 3000, -0.0022, 0.7};
  description.configuration = "# of the run\nrecord: true\n";
  description.program_version = "0.1.0";
  return description;
}

// No limit but the disk's.
inline RecordingLimits noLimits() { return {std::int64_t{1} << 60, -(std::int64_t{1} << 60)}; }

// Tests that inherit it have their temporary folders in memory, where waiting for the disk takes no time.
class TestInMemory : public ::testing::Test {
 protected:
  TestInMemory() {
    if (const char* value = std::getenv("TMPDIR")) before_ = value;
    if (::access("/dev/shm", W_OK) == 0) ::setenv("TMPDIR", "/dev/shm", 1);
  }
  ~TestInMemory() override { before_ ? ::setenv("TMPDIR", before_->c_str(), 1) : ::unsetenv("TMPDIR"); }

 private:
  std::optional<std::string> before_;
};

inline std::int64_t madeTime(int i) { return 1305031102175304123 + std::int64_t{33'333'367} * i; }

inline cv::Mat madeFrame(int i) {
  cv::Mat grey(made_height, made_width, CV_8UC1);
  cv::RNG(static_cast<std::uint64_t>(i) + 1).fill(grey, cv::RNG::UNIFORM, 0, 256);
  return grey;
}

// A frame whose file takes only some hundred bytes.
inline cv::Mat flatFrame(int i) { return cv::Mat(made_height, made_width, CV_8UC1, cv::Scalar(i % 256)); }

inline bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0;
}

// The files in an archive as POSIX has it, up to the first one that is not whole.
inline std::map<std::string, std::string> unpacked(const std::string& archive) {
  constexpr std::size_t block = 512;
  std::map<std::string, std::string> files;
  for (std::size_t at = 0; at + block <= archive.size();) {
    const std::string header = archive.substr(at, block);
    unsigned sum = 0;
    for (std::size_t i = 0; i < block; ++i) {
      sum += i >= 148 && i < 156 ? ' ' : static_cast<unsigned char>(header[i]);
    }
    const bool is_header =
        header.compare(257, 6, "ustar\0", 6) == 0 && sum == std::stoul(header.substr(148, 6), nullptr, 8);
    if (!is_header) throw std::runtime_error("no header at byte " + std::to_string(at));
    const std::size_t size = std::stoul(header.substr(124, 11), nullptr, 8);
    if (size > archive.size() - at - block) break;
    files[header.c_str()] = archive.substr(at + block, size);
    at += block + (size + block - 1) / block * block;
  }
  return files;
}

// 10 frames processed (0 1 2 4 5 6 8 9 10 11), one dropped (3), one unreadable (7); lines of all these kinds.
inline void writeMadeRecording(const std::string& folder) {
  RecordingWriter writer;
  writer.open(folder, madeDescription(), noLimits());
  for (int i = 0; i < 12; ++i) {
    if (i == 3) {
      writer.writeDecision({DecisionKind::dropped, i, madeTime(i), 0, ""});
    } else if (i == 7) {
      writer.writeDecision({DecisionKind::unreadable, i, madeTime(i), 0, "the cable\nis loose"});
    } else {
      if (i % 4 == 1) writer.writeDecision({DecisionKind::update, i, 0, 100 + i, ""});
      if (i % 4 == 2) writer.writeDecision({DecisionKind::correction, i / 4, 0, 50 + i, ""});
      writer.writeFrame(i, madeTime(i), madeFrame(i));
    }
    if (i % 5 == 4) writer.sync();
  }
  writer.close();
}

// Expects each frame of the recording, unreadable ones apart, to be the one made for its index.
template <typename MakeFrame>
void expectFramesAsMade(const Recording& recording, const MakeFrame& make) {
  if (recording.frames.empty()) return;
  RecordingSource source(recording);
  for (const RecordedFrame& expected : recording.frames) {
    const std::optional<Frame> frame = source.next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->index, expected.index);
    EXPECT_EQ(frame->time_ns, madeTime(static_cast<int>(expected.index)));
    EXPECT_EQ(frame->problem, expected.problem);
    if (expected.problem.empty()) {
      EXPECT_TRUE(same(frame->grey, make(static_cast<int>(expected.index))));
    }
  }
  EXPECT_FALSE(source.next());
}

}  // namespace edgeslam
