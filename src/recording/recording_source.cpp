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
#include "image_formats/image_header.h"
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

// In rgb/, of a recording whose frames are files.
std::string framePath(const Recording& recording, std::int64_t time_ns) {
  return (fs::path(recording.folder) / tum_frames_name / tumFrameName(time_ns)).string();
}

std::string archivePath(const Recording& recording) { return recording.folder + "/" + frame_archive_name; }

int readFormat(const std::string& version, const std::string& place) {
  for (int known = 1; known <= recording_format_version; ++known) {
    if (version == std::to_string(known)) return known;
  }
  throw InputError(place + "format version " + version + "; this program reads version 1 to " +
                   std::to_string(recording_format_version));
}

struct Versions {
  int format = 0;  // 0: not read yet
  std::string program;
};

// recording.txt
Versions readVersions(const std::string& path) {
  checkFile(path, 1 << 16);
  Versions versions;
  for (const TextLine& line : readTextLines(path)) {
    const std::string place = placeInFile(path, line.number);
    const std::size_t blank = std::min(line.text.find(' '), line.text.size());
    const std::string key = line.text.substr(0, blank);
    const std::string value = line.text.substr(std::min(blank + 1, line.text.size()));
    if (key == "format") {
      versions.format = readFormat(value, place);
    } else if (key == "program") {
      versions.program = value;
    } else {
      throw InputError(place + "expected 'format VERSION' or 'program VERSION', found '" + line.text + "'");
    }
  }
  if (versions.format == 0) throw InputError(path + ": the line 'format VERSION' is missing");
  return versions;
}

struct DecisionLines {
  std::vector<Decision> decisions;
  bool ended = false;  // by the line of a clean end
  std::string note;    // why there is no such line
};

// Throws InputError where what stands behind the numbers is nothing that the recorder could have written.
void checkText(const Decision& decision, int format, const Camera& camera, const std::string& place) {
  const auto unlessThere = [&](bool there, const std::string& expected) {
    if (!there) throw InputError(place + "expected " + expected + ", found '" + decision.text + "'");
  };
  if (decision.kind == DecisionKind::frame && format < first_archive_format) {
    unlessThere(decision.text.empty(),
                "nothing after the frame's time stamp in a recording of format " + std::to_string(format));
  } else if (decision.kind == DecisionKind::frame) {
    const std::optional<ArchivedImage> image = archivedImageOf(decision);
    const std::int64_t most = largestArchivedImage(camera.width, camera.height);
    unlessThere(image && image->size <= most, "OFFSET SIZE CHECKSUM of an image of " + std::to_string(camera.width) +
                                                  " x " + std::to_string(camera.height) + " pixels in " +
                                                  std::to_string(most) + " bytes at most");
  } else if (decision.kind == DecisionKind::inertia) {
    unlessThere(inertialSampleOf(decision).has_value(), "six numbers that an inertial unit can have measured");
  } else if (decision.kind == DecisionKind::wheels) {
    unlessThere(odometryPoseOf(decision).has_value(), "seven numbers, a position [m] and a unit quaternion");
  }
}

DecisionLines readDecisionLines(const std::string& path, int format, const Camera& camera) {
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
    checkText(decision, format, camera, place);
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

// Why the frame of this decision is not there whole, with its place; otherwise empty.
std::string problemOfFrame(const Recording& recording, const Decision& decision) {
  if (const auto image = archivedImageOf(decision)) return readArchivedImage(archivePath(recording), *image).problem;
  const std::string path = framePath(recording, decision.time_ns);
  return isWholePng(path) ? "" : path + ": is missing or cut off";
}

// Ends the recording where frames are listed and none of them is there: a disk that lost more than it confirmed, or a
// copy that broke off.
void endBeforeMissingFrames(DecisionLines& lines, const Recording& recording) {
  std::size_t end = lines.decisions.size();
  std::string problem;
  for (std::size_t i = lines.decisions.size(); i-- > 0;) {
    const Decision& decision = lines.decisions[i];
    if (decision.kind != DecisionKind::frame) continue;
    const std::string problem_here = problemOfFrame(recording, decision);
    if (problem_here.empty()) break;
    problem = problem_here;
    end = i;
  }
  if (end == lines.decisions.size()) return;
  lines.ended = false;
  lines.note += (lines.note.empty() ? "" : "; ") + problem +
                ", and so it is with all that follow; the recording ends before frame " +
                std::to_string(lines.decisions[end].index);
  lines.decisions.resize(end);
}

// By its header, which a decoder would make room for; as in any frame that a camera sent whole.
bool isJpegOfSize(const std::string& bytes, cv::Size size) {
  if (imageFormat(bytes) != ImageFormat::jpeg || !canHoldItsSize(bytes)) return false;
  const std::optional<ClaimedSize> claimed = claimedSize(bytes);
  return claimed && claimed->width == size.width && claimed->height == size.height;
}

// As the live run saw it: what a camera sent is decoded by what decoded it then.
DecodedImage decodeFrame(const std::string& bytes, const ExpectedSize& expected, JpegDecoder& jpeg) {
  if (!isJpegOfSize(bytes, expected.size)) return decodeGreyImage(bytes, expected);
  cv::Mat grey(expected.size, CV_8U);
  const std::string problem = jpeg.decode(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), grey);
  return {problem.empty() ? grey : cv::Mat(), problem};
}

DecodedImage readArchivedFrame(const std::string& path, const ArchivedImage& where, const ExpectedSize& expected,
                               JpegDecoder& jpeg) {
  const ArchivedBytes file = readArchivedImage(path, where);
  if (!file.problem.empty()) return {{}, file.problem};
  DecodedImage image = decodeFrame(file.bytes, expected, jpeg);
  if (!image.problem.empty()) image.problem.insert(0, placeInArchive(path, where));
  return image;
}

void take(const Decision& decision, Recording& recording) {
  Decisions& decisions = recording.decisions;
  switch (decision.kind) {
    case DecisionKind::frame:
    case DecisionKind::unreadable:
      recording.frames.push_back({decision.index, decision.time_ns, "", archivedImageOf(decision)});
      if (decision.kind == DecisionKind::unreadable) {
        recording.frames.back().problem = decision.text.empty() ? "the camera's frame was unreadable" : decision.text;
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
  const Versions versions = readVersions(folder + "/" + recording_description_name);
  recording.program_version = versions.program;
  recording.configuration_path = folder + "/" + recording_configuration_name;
  checkFile(recording.configuration_path, 1 << 24);
  recording.camera = readCalibration(folder + "/" + tum_camera_name);
  DecisionLines lines = readDecisionLines(folder + "/" + recording_decisions_name, versions.format, recording.camera);
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
  const ExpectedSize expected{{recording_.camera.width, recording_.camera.height},
                              recording_.folder + "/" + tum_camera_name + " says"};
  DecodedImage image = recorded.image ? readArchivedFrame(archivePath(recording_), *recorded.image, expected, jpeg_)
                                      : readGreyImage(framePath(recording_, recorded.time_ns), expected);
  frame.problem = image.problem;
  frame.grey = std::move(image.grey);
  return frame;
}

std::string RecordingSource::groundTruthPath() const {
  const std::string path = recording_.folder + "/groundtruth.txt";
  return isFile(path) ? path : "";
}

}  // namespace edgeslam
