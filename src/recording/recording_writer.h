// The flight recorder's storage: frames and decisions of a live run, kept so that a power cut takes no more than what
// came after the last sync(). What is on disk is readable at every moment, however the recording ends.
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "frames/frame_encoding.h"
#include "geometry/camera.h"
#include "recording/recording_files.h"
#include "recording/recording_layout.h"

namespace edgeslam {

// What belongs to a recording besides frames and decisions.
struct RecordingDescription {
  Camera camera;
  std::string configuration;    // text of the run's configuration file, which names the mask beside it
  std::string program_version;  // one line
};

struct RecordingLimits {
  std::int64_t budget_bytes = std::int64_t{4} << 30;       // disk space that the recording may take, whole blocks
  std::int64_t free_bytes_kept = std::int64_t{256} << 20;  // of the disk's free space, for others
};

struct RecordingStatus {
  bool recording = false;
  std::int64_t frames = 0;        // written
  std::int64_t bytes = 0;         // of the disk, whole blocks
  std::int64_t not_recorded = 0;  // frames and decisions; above 0, the recording does not repeat the run
  std::string message;            // how it goes or why it ended, for people
};

class RecordingWriter {
 public:
  RecordingWriter() = default;
  // Keeps what was written, without the line that tells a clean end.
  ~RecordingWriter();
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;
  RecordingWriter(RecordingWriter&&) = delete;
  RecordingWriter& operator=(RecordingWriter&&) = delete;

  // Makes the folder, or takes an empty one. Call once. Throws InputError where that fails, and then leaves nothing
  // behind.
  void open(const std::string& folder, const RecordingDescription& description, const RecordingLimits& limits = {});

  // `grey`: CV_8U of the camera's size. False where it was not recorded: a gap, counted and written down, where the
  // frame cannot be one of the recording (its size, its index or time stamp not above those before); otherwise
  // recording has ended, see status().
  bool writeFrame(std::int64_t index, std::int64_t time_ns, const cv::Mat& grey, FrameCode code = FrameCode::packed);
  // Likewise, as the camera sent the frame: its bytes are kept as they are.
  bool writeJpeg(std::int64_t index, std::int64_t time_ns, const std::vector<unsigned char>& jpeg);
  // Of any kind but `frame`, `stopped` and `end`. False as for writeFrame. Write a frame's updates before the frame, so
  // that a recording which breaks off between the two still repeats the run.
  bool writeDecision(const Decision& decision);
  // Waits until the disk holds all that was written: frames first, then the lists that name them. Call it once a
  // second. False where recording has ended.
  bool sync();
  // The run's clean end: writes that down and syncs. The recording ends without it where that fails.
  void close();

  const RecordingStatus& status() const { return status_; }

 private:
  bool writeImage(std::int64_t index, std::int64_t time_ns, const std::vector<unsigned char>& image,
                  const std::string& ending);
  bool keepsLimits(std::int64_t bytes);
  bool refuse(const std::string& problem);
  void addLine(const Decision& decision);
  std::string flush();
  void end(const std::string& reason);
  void finish(const std::string& how);

  std::string folder_;
  RecordingLimits limits_;
  cv::Size size_;  // of the frames
  std::unique_ptr<RecordingFiles> files_;
  RecordingStatus status_;
  DecisionOrder order_;
  std::string waiting_decisions_, waiting_list_;  // lines that name what the disk has not confirmed yet
  std::vector<unsigned char> image_;              // file of the frame that is being written
};

}  // namespace edgeslam
