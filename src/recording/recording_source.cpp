#include "recording/recording_source.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <system_error>
#include <utility>

#include "files/text_file.h"
#include "frames/calibration_file.h"
#include "frames/image_file.h"
#include "recording/recording_layout.h"

namespace edgeslam {
namespace {

namespace fs = std::filesystem;

bool isFile(const std::string& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

void checkFile(const std::string& path, std::uintmax_t largest_bytes) {
  if (!isFile(path)) throw InputError(path + ": no such file; a recording has it");
  std::error_code error;
  if (fs::file_size(path, error) > largest_bytes || error) throw InputError(path + ": too large for a recording");
}

std::string framePath(const Recording& recording, std::int64_t time_ns) {
  return (fs::path(recording.folder) / tum_frames_name / tumFrameName(time_ns)).string();
}

void checkFormat(const std::string& version, const std::string& place) {
  const std::string known = std::to_string(recording_format_version);
  if (version == known || version == "1") return;
  throw InputError(place + "format version " + version + "; this program reads version 1 to " + known);
}

// recording.txt: the program's version.
std::string readProgramVersion(const std::string& path) {
  checkFile(path, 1 << 16);
  std::string version;
  bool format_known = false;
  for (const TextLine& line : readTextLines(path)) {
    const std::string place = placeInFile(path, line.number);
    const std::size_t blank = std::min(line.text.find(' '), line.text.size());
    const std::string key = line.text.substr(0, blank);
    const std::string value = line.text.substr(std::min(blank + 1, line.text.size()));
    if (key == "format") {
      checkFormat(value, place);
      format_known = true;
    } else if (key == "program") {
      version = value;
    } else {
      throw InputError(place + "expected 'format VERSION' or 'program VERSION', found '" + line.text + "'");
    }
  }
  if (!format_known) throw InputError(path + ": the line 'format VERSION' is missing");
  return version;
}

struct DecisionLines {
  std::vector<Decision> decisions;
  bool ended = false;  // by the line of a clean end
  std::string note;    // why there is no such line
};

DecisionLines readDecisionLines(const std::string& path) {
  constexpr std::uintmax_t largest_bytes = std::uintmax_t{1} << 29;  // days of frames
  checkFile(path, largest_bytes);
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path + ": cannot be opened: " + std::generic_category().message(errno));
  DecisionLines lines;
  DecisionOrder order;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const std::string place = placeInFile(path, number);
    const std::optional<std::string_view> text = undamagedDecision(line);
    if (!text) {
      lines.ended = false;
      lines.note = place + "the line is torn or damaged; the recording ends before it";
      return lines;
    }
    const Decision decision = parseDecision(*text, place);
    if (const std::string problem = order.add(decision); !problem.empty()) throw InputError(place + problem);
    if (decision.kind == DecisionKind::inertia && !inertialSampleOf(decision)) {
      throw InputError(place + "expected six numbers that an inertial unit can have measured, found '" + decision.text +
                       "'");
    }
    if (decision.kind == DecisionKind::wheels && !odometryPoseOf(decision)) {
      throw InputError(place + "expected seven numbers, a position [m] and a unit quaternion, found '" + decision.text +
                       "'");
    }
    if (decision.kind == DecisionKind::stopped) lines.note = "recording stopped before the run did: " + decision.text;
    lines.ended = decision.kind == DecisionKind::end;
    lines.decisions.push_back(decision);
  }
  if (file.bad()) throw InputError(path + ": reading failed: " + std::generic_category().message(errno));
  if (!lines.ended && lines.note.empty()) lines.note = path + ": breaks off without the run's end";
  return lines;
}

// Begins and ends as a PNG file does. What is damaged between is found by its checksums when it is decoded.
bool isWholePng(const std::string& path) {
  constexpr std::array<unsigned char, 8> signature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  constexpr std::array<unsigned char, 12> last_chunk{0, 0, 0, 0, 'I', 'E', 'N', 'D', 0xAE, 0x42, 0x60, 0x82};
  if (!isFile(path)) return false;
  std::ifstream file(path, std::ios::binary);
  std::array<char, 12> bytes{};
  if (!file.read(bytes.data(), signature.size())) return false;
  if (std::memcmp(bytes.data(), signature.data(), signature.size()) != 0) return false;
  if (!file.seekg(-static_cast<std::streamoff>(last_chunk.size()), std::ios::end)) return false;
  if (!file.read(bytes.data(), last_chunk.size())) return false;
  return std::memcmp(bytes.data(), last_chunk.data(), last_chunk.size()) == 0;
}

// Ends the recording where frames are listed and none of them is there: a disk that lost more than it confirmed, or a
// copy that broke off.
void endBeforeMissingFrames(DecisionLines& lines, const Recording& recording) {
  std::size_t end = lines.decisions.size();
  for (std::size_t i = lines.decisions.size(); i-- > 0;) {
    const Decision& decision = lines.decisions[i];
    if (decision.kind != DecisionKind::frame) continue;
    if (isWholePng(framePath(recording, decision.time_ns))) break;
    end = i;
  }
  if (end == lines.decisions.size()) return;
  const Decision& missing = lines.decisions[end];
  lines.ended = false;
  lines.note += (lines.note.empty() ? "" : "; ") + framePath(recording, missing.time_ns) +
                ": is missing or cut off, and so is all that follows; the recording ends before frame " +
                std::to_string(missing.index);
  lines.decisions.resize(end);
}

void take(const Decision& decision, Recording& recording) {
  Decisions& decisions = recording.decisions;
  switch (decision.kind) {
    case DecisionKind::frame:
    case DecisionKind::unreadable:
      recording.frames.push_back({decision.index, decision.time_ns, decision.text});
      if (decision.kind == DecisionKind::unreadable && decision.text.empty()) {
        recording.frames.back().problem = "the camera's frame was unreadable";
      }
      break;
    case DecisionKind::dropped:
      decisions.dropped.push_back({decision.index, decision.time_ns});
      break;
    case DecisionKind::update:
      decisions.updates.push_back({decision.index, decision.number});
      break;
    case DecisionKind::inertia:
      decisions.inertia.push_back({decision.index, *inertialSampleOf(decision)});
      break;
    case DecisionKind::wheels:
      decisions.wheels.push_back({decision.index, *odometryPoseOf(decision)});
      break;
    case DecisionKind::busy:
      decisions.busy.push_back(decision.index);
      break;
    case DecisionKind::correction:
      decisions.corrections.push_back({decision.index, decision.number});
      break;
    case DecisionKind::gap:
      decisions.not_recorded +=
          std::min(decision.number, std::numeric_limits<std::int64_t>::max() - decisions.not_recorded);
      break;
    case DecisionKind::stopped:
    case DecisionKind::end:
      break;
  }
}

}  // namespace

RunDecisions runDecisions(const Decisions& recorded) {
  RunDecisions decisions;
  for (const UpdateTaken& update : recorded.updates) decisions.updates[update.frame_index] = update.number;
  for (const InertiaGiven& given : recorded.inertia) decisions.inertia[given.frame_index].push_back(given.sample);
  for (const WheelsGiven& given : recorded.wheels) decisions.wheels[given.frame_index].push_back(given.pose);
  decisions.mapping_busy.insert(recorded.busy.begin(), recorded.busy.end());
  for (const CorrectionApplied& correction : recorded.corrections) {
    decisions.corrections[correction.message].push_back(correction.number);
    decisions.snapshots.insert(correction.number);
  }
  return decisions;
}

bool isRecording(const std::string& folder) { return isFile(folder + "/" + recording_description_name); }

Recording readRecording(const std::string& folder) {
  Recording recording;
  recording.folder = folder;
  recording.program_version = readProgramVersion(folder + "/" + recording_description_name);
  recording.configuration_path = folder + "/" + recording_configuration_name;
  checkFile(recording.configuration_path, 1 << 24);
  recording.camera = readCalibration(folder + "/" + tum_camera_name);
  DecisionLines lines = readDecisionLines(folder + "/" + recording_decisions_name);
  endBeforeMissingFrames(lines, recording);
  for (const Decision& decision : lines.decisions) take(decision, recording);
  Decisions& decisions = recording.decisions;
  decisions.complete = lines.ended && decisions.not_recorded == 0;
  decisions.note = lines.note;
  if (decisions.not_recorded > 0) {
    decisions.note += (decisions.note.empty() ? "" : "; ") + std::to_string(decisions.not_recorded) +
                      " frames or decisions were not recorded, so that the run cannot be repeated exactly";
  }
  return recording;
}

RecordingSource::RecordingSource(Recording recording) : recording_(std::move(recording)) {
  if (!recording_.frames.empty()) return;
  throw InputError(recording_.folder + ": the recording holds no frames" +
                   (recording_.decisions.note.empty() ? "" : "; " + recording_.decisions.note));
}

std::optional<Frame> RecordingSource::next() {
  if (next_ >= recording_.frames.size()) return std::nullopt;
  const RecordedFrame& recorded = recording_.frames[next_++];
  Frame frame;
  frame.index = recorded.index;
  frame.time_ns = recorded.time_ns;
  frame.problem = recorded.problem;
  if (!frame.problem.empty()) return frame;
  const std::string path = framePath(recording_, recorded.time_ns);
  DecodedImage image = readGreyImage(
      path, {{recording_.camera.width, recording_.camera.height}, recording_.folder + "/" + tum_camera_name + " says"});
  frame.problem = image.problem;
  frame.grey = std::move(image.grey);
  return frame;
}

std::string RecordingSource::groundTruthPath() const {
  const std::string path = recording_.folder + "/groundtruth.txt";
  return isFile(path) ? path : "";
}

}  // namespace edgeslam
