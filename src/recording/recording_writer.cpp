#include "recording/recording_writer.h"

#include <algorithm>
#include <cassert>
#include <exception>

#include "edgeslam/input_error.h"
#include "files/text_file.h"
#include "frames/calibration_file.h"
#include "frames/mask_file.h"

namespace edgeslam {
namespace {

constexpr std::int64_t block_bytes = 4096;           // of the disk
constexpr std::int64_t closing_bytes = block_bytes;  // kept for the line that says why recording stopped
constexpr std::size_t most_waiting_bytes = 1 << 16;  // of lines

std::int64_t wholeBlocks(std::size_t bytes) {
  return (static_cast<std::int64_t>(bytes) + block_bytes - 1) / block_bytes * block_bytes;
}

std::string formatDescription(const std::string& program_version) {
  std::string version = program_version.substr(0, 200);
  std::replace_if(
      version.begin(), version.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return "# Edge SLAM recording. Frames: rgb.tar; what the run did with them: decisions.txt.\nformat " +
         std::to_string(recording_format_version) + "\nprogram " + version + "\n";
}

}  // namespace

RecordingWriter::~RecordingWriter() {
  try {
    sync();
  } catch (const std::exception&) {  // no memory; the recording ends with the sync before
  }
}

void RecordingWriter::open(const std::string& folder, const RecordingDescription& description,
                           const RecordingLimits& limits) {
  assert(!files_);
  const std::string camera = formatCalibrationFile(description.camera);
  const std::string program = formatDescription(description.program_version);
  const std::string mask = description.camera.mask ? encodeMask(*description.camera.mask) : "";
  files_ = std::make_unique<RecordingFiles>(folder, camera, description.configuration, program, mask);
  folder_ = folder;
  limits_ = limits;
  size_ = {description.camera.width, description.camera.height};
  status_.recording = true;
  status_.message = "recording to " + folder;
  constexpr std::int64_t folders_and_lists = 4 * block_bytes;
  status_.bytes = wholeBlocks(camera.size()) + wholeBlocks(program.size()) + wholeBlocks(mask.size()) +
                  wholeBlocks(description.configuration.size()) + folders_and_lists;
}

bool RecordingWriter::writeFrame(std::int64_t index, std::int64_t time_ns, const cv::Mat& grey, FrameCode code) {
  if (!status_.recording) return false;
  if (grey.type() != CV_8UC1 || grey.size() != size_) {
    return refuse("frame " + std::to_string(index) + " is not of the camera's size in 8 bits of grey");
  }
  if (!encodeFrame(grey, code, image_)) return refuse("no memory to encode frame " + std::to_string(index));
  return writeImage(index, time_ns, image_, fileEnding(code));
}

bool RecordingWriter::writeJpeg(std::int64_t index, std::int64_t time_ns, const std::vector<unsigned char>& jpeg) {
  return status_.recording && writeImage(index, time_ns, jpeg, ".jpg");
}

bool RecordingWriter::writeImage(std::int64_t index, std::int64_t time_ns, const std::vector<unsigned char>& image,
                                 const std::string& ending) {
  const std::string_view content(reinterpret_cast<const char*>(image.data()), image.size());
  const Decision decision = frameDecision(
      index, time_ns, {files_->nextOffset(), static_cast<std::int64_t>(image.size()), imageChecksum(content)});
  if (std::string problem = order_.add(decision); !problem.empty()) return refuse(problem);
  const auto bytes = static_cast<std::int64_t>(archive_block + image.size() + archivePadding(image.size()));
  if (!keepsLimits(bytes)) return false;
  const std::string name = formatStamp(time_ns) + ending;
  if (std::string problem = files_->addFrame(name, time_ns, image); !problem.empty()) {
    end(problem);
    return false;
  }
  status_.bytes += bytes;
  ++status_.frames;
  const std::string line = formatStamp(time_ns) + " " + tum_frames_name + "/" + name + "\n";
  waiting_list_ += line;
  status_.bytes += static_cast<std::int64_t>(line.size());
  addLine(decision);
  return true;
}

bool RecordingWriter::writeDecision(const Decision& decision) {
  if (!status_.recording) return false;
  if (decision.kind == DecisionKind::frame || decision.kind == DecisionKind::stopped ||
      decision.kind == DecisionKind::end) {
    return refuse("a decision of a kind that is not written so");
  }
  if (std::string problem = order_.add(decision); !problem.empty()) return refuse(problem);
  if (!keepsLimits(0)) return false;
  if (decision.kind == DecisionKind::gap) {
    status_.not_recorded += decision.number;
    status_.message = "recording to " + folder_ + ", with gaps";
  }
  addLine(decision);
  return waiting_decisions_.size() < most_waiting_bytes || sync();
}

bool RecordingWriter::sync() {
  if (!status_.recording) return false;
  const std::string problem = flush();
  if (!problem.empty()) finish("ended after " + std::to_string(status_.frames) + " frames: " + problem);
  return status_.recording;
}

void RecordingWriter::close() {
  if (!status_.recording) return;
  const Decision decision{DecisionKind::end, 0, 0, 0, ""};
  order_.add(decision);
  addLine(decision);
  const std::string gaps = ", without " + std::to_string(status_.not_recorded) + " frames or decisions";
  if (sync()) finish("ended with the run" + (status_.not_recorded > 0 ? gaps : ""));
}

// Ends the recording where `bytes` more would not leave room for its last lines.
bool RecordingWriter::keepsLimits(std::int64_t bytes) {
  if (status_.bytes + bytes + closing_bytes > limits_.budget_bytes) {
    end("the budget of " + std::to_string(limits_.budget_bytes) + " bytes is used up");
  } else if (files_->freeBytes() - bytes < limits_.free_bytes_kept) {
    end("the disk has less than " + std::to_string(limits_.free_bytes_kept) + " bytes free");
  }
  return status_.recording;
}

// A frame or decision that cannot be in the recording, which goes on with a gap.
bool RecordingWriter::refuse(const std::string& problem) {
  if (!keepsLimits(0)) return false;
  ++status_.not_recorded;
  status_.message = "recording to " + folder_ + ", with gaps: " + problem;
  addLine({DecisionKind::gap, 0, 0, 1, ""});
  return false;
}

void RecordingWriter::addLine(const Decision& decision) {
  const std::string line = formatDecision(decision);
  waiting_decisions_ += line;
  status_.bytes += static_cast<std::int64_t>(line.size());
}

// Empty, or what failed.
std::string RecordingWriter::flush() {
  std::string problem = files_->confirmFrames();
  if (problem.empty()) problem = files_->appendDecisions(waiting_decisions_);
  if (problem.empty()) problem = files_->appendList(waiting_list_);
  waiting_decisions_.clear();
  waiting_list_.clear();
  return problem;
}

// What is written already stays, and why there is no more is written where there is room for it.
void RecordingWriter::end(const std::string& reason) {
  addLine({DecisionKind::stopped, 0, 0, 0, reason});
  flush();
  finish("ended after " + std::to_string(status_.frames) + " frames: " + reason);
}

void RecordingWriter::finish(const std::string& how) {
  status_.recording = false;
  status_.message = "recording to " + folder_ + " " + how;
  files_.reset();
}

}  // namespace edgeslam
