// Reads a recording of the flight recorder (recording_layout.h): its frames in order, and the decisions with which the
// live run can be repeated.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "frames/frame_source.h"
#include "image_formats/jpeg_decoder.h"
#include "pipeline/run_decisions.h"
#include "recording/frame_archive.h"

namespace edgeslam {

// Before processing frame `frame_index`, tracking took map update `number`.
struct UpdateTaken {
  std::int64_t frame_index = 0;
  std::int64_t number = 0;
};

// Before handling message `message`, mapping applied correction `number`.
struct CorrectionApplied {
  std::int64_t message = 0;
  std::int64_t number = 0;
};

// Before processing frame `frame_index`, tracking was given this.
struct InertiaGiven {
  std::int64_t frame_index = 0;
  InertialSample sample;
};

// Likewise of the wheels.
struct WheelsGiven {
  std::int64_t frame_index = 0;
  OdometryPose pose;
};

struct DroppedFrame {
  std::int64_t index = 0;
  std::int64_t time_ns = 0;
};

// What the live run did, in its order, as far as the recording reaches.
struct Decisions {
  std::vector<UpdateTaken> updates;
  std::vector<CorrectionApplied> corrections;
  std::vector<InertiaGiven> inertia;
  std::vector<WheelsGiven> wheels;
  std::vector<DroppedFrame> dropped;
  std::vector<std::int64_t> busy;  // frames that told mapping nothing, mapping being far behind
  std::int64_t not_recorded = 0;   // frames and decisions; above 0, the recording does not repeat the run
  bool complete = false;           // reaches to the run's clean end, and nothing is missing
  std::string note;                // why it is not complete, for people; empty otherwise
};

// As a lockstep run repeats them.
RunDecisions runDecisions(const Decisions& recorded);

struct RecordedFrame {
  std::int64_t index = 0;  // over all frames of the camera, dropped ones included
  std::int64_t time_ns = 0;
  std::string problem;                 // why the live run could not read it; empty otherwise
  std::optional<ArchivedImage> image;  // in rgb.tar; none: it is a file in rgb/
};

struct Recording {
  std::string folder;
  std::string program_version;
  std::string configuration_path;  // of the run's edgeslam.yaml
  Camera camera;
  std::vector<RecordedFrame> frames;  // unreadable ones included, dropped ones not
  Decisions decisions;
};

// True where the folder holds a recording.txt.
bool isRecording(const std::string& folder);

// Reads up to the first line of decisions.txt that is torn or damaged, and up to where the frames listed are no longer
// there: a recording that broke off is used as far as it reaches, and the note tells it. Throws InputError with file
// and line where a file is missing or of another format version, or a line whose checksum is right is none that the
// recorder could have written there.
Recording readRecording(const std::string& folder);

// The frames that the live run processed, with the indices they had there.
class RecordingSource : public FrameSource {
 public:
  // Throws InputError where the recording holds no frame.
  explicit RecordingSource(Recording recording);

  std::optional<Frame> next() override;
  std::int64_t size() const override { return static_cast<std::int64_t>(recording_.frames.size()); }
  std::string kind() const override { return "recording"; }
  std::optional<Camera> camera() const override { return recording_.camera; }
  // A groundtruth.txt that was put beside the recording afterwards.
  std::string groundTruthPath() const override;

  const Recording* recording() const override { return &recording_; }

 private:
  Recording recording_;
  std::size_t next_ = 0;
  JpegDecoder jpeg_;
};

}  // namespace edgeslam
