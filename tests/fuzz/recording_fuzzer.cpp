// Recordings: decisions.txt, recording.txt, camera.yaml and rgb.tar, parted by lines "====". Frames and decisions in an
// order that a run can have, or one message. Each line of decisions.txt gets its checksum here, but for those that
// begin with '!', and so does an image of rgb.tar whose line ends in '?'. Where rgb.tar is empty it has a frame as PNG,
// one as PGM, and a PNG cut off. Frames of the earlier formats are those of 1, 2 and 3 s, the last one cut off.
#include <zlib.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>

#include "fuzz_input.h"
#include "recording/recording_layout.h"
#include "recording/recording_source.h"

namespace {

using namespace edgeslam;

// A '?' at the end of a frame's line becomes the checksum of what lies at its place in the archive.
std::string withImageChecksum(std::string_view line, std::string_view archive) {
  std::string text(line);
  if (text.empty() || text.back() != '?') return text;
  unsigned long offset = 0, image_size = 0;
  if (std::sscanf(text.c_str(), "frame %*s %*s %lu %lu ?", &offset, &image_size) != 2 || offset > archive.size())
    return text;
  char digits[16];
  std::snprintf(digits, sizeof digits, "%08x", imageChecksum(archive.substr(offset, image_size)));
  text.pop_back();
  return text + digits;
}

std::string withChecksums(std::string_view lines, std::string_view archive) {
  std::string text;
  while (!lines.empty()) {
    const std::size_t end = std::min(lines.find('\n'), lines.size());
    const std::string line = withImageChecksum(lines.substr(0, end), archive);
    lines.remove_prefix(std::min(end + 1, lines.size()));
    if (!line.empty() && line.front() == '!') {
      text.append(line, 1).append("\n");
      continue;
    }
    char digits[16];
    const auto checksum = crc32_z(0, reinterpret_cast<const Bytef*>(line.data()), line.size());
    std::snprintf(digits, sizeof digits, " %08lx\n", static_cast<unsigned long>(checksum));
    text.append(line).append(digits);
  }
  return text;
}

// The folder, with the files that no input changes.
class RecordingFolder : public MemoryFolder {
 public:
  RecordingFolder();
  std::string archive;
};

RecordingFolder::RecordingFolder() {
  std::vector<unsigned char> png;
  cv::imencode(".png", cv::Mat(16, 16, CV_8U, cv::Scalar(128)), png);
  const std::string content(png.begin(), png.end());
  write("rgb/1.000000000.png", content);
  write("rgb/2.000000000.png", content);
  write("rgb/3.000000000.png", content.substr(0, content.size() / 2));
  const std::string pgm = "P5\n16 16\n255\n" + std::string(256, 'x');
  archive = std::string(archive_block, '\0') + content;
  archive.resize(2 * archive_block);
  archive += std::string(archive_block, '\0') + pgm;
  archive.resize(4 * archive_block);
  archive += std::string(archive_block, '\0') + content.substr(0, content.size() / 2);
  write(recording_configuration_name, "");
}

// A decision that was read is written and read again the same.
void requireReadBack(std::string_view line) {
  try {
    const Decision decision = parseDecision(line, "decisions.txt:1: ");
    const std::string written = formatDecision(decision);
    const auto undamaged = undamagedDecision(std::string_view(written).substr(0, written.size() - 1));
    require(undamaged.has_value(), "a written decision has its checksum");
    const Decision again = parseDecision(*undamaged, "");
    require(again.kind == decision.kind && again.index == decision.index && again.time_ns == decision.time_ns &&
                again.number == decision.number && again.text == decision.text,
            "a written decision is read back the same");
  } catch (const InputError& error) {
    requireMessage(error.what(), "decisions.txt:1: ");
  }
}

void requireOrder(const Recording& recording) {
  for (std::size_t i = 1; i < recording.frames.size(); ++i) {
    require(recording.frames[i - 1].index < recording.frames[i].index, "indices of frames grow");
    require(recording.frames[i - 1].time_ns < recording.frames[i].time_ns, "time stamps grow");
  }
  const Decisions& decisions = recording.decisions;
  require(decisions.not_recorded >= 0, "counts are not negative");
  require(decisions.complete == decisions.note.empty(), "a recording that is not complete says why");
  require(!decisions.complete || decisions.not_recorded == 0, "what is complete lacks nothing");
  if (!decisions.note.empty()) requireMessage(decisions.note, "");
}

void readFrames(Recording recording) {
  RecordingSource source(std::move(recording));
  std::int64_t frames = 0;
  while (const std::optional<Frame> frame = source.next()) {
    ++frames;
    require(frame->grey.empty() != frame->problem.empty(), "a frame has an image or a problem");
    if (!frame->problem.empty()) requireMessage(frame->problem, "");
    const Camera& camera = source.recording()->camera;
    require(frame->grey.empty() || (frame->grey.cols == camera.width && frame->grey.rows == camera.height),
            "images are of the camera's size");
  }
  require(frames == source.size(), "all frames come");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const RecordingFolder folder;
  const auto files = splitFiles(data, size, 4);
  requireReadBack(files[0].substr(0, files[0].find('\n')));
  const std::string_view archive = files[3].empty() ? folder.archive : files[3];
  folder.write(recording_decisions_name, withChecksums(files[0], archive));
  folder.write(frame_archive_name, archive);
  folder.write(recording_description_name, files[1]);
  folder.write(tum_camera_name, files[2]);
  try {
    Recording recording = readRecording(folder.path());
    requireOrder(recording);
    readFrames(std::move(recording));
  } catch (const InputError& error) {
    requireMessage(error.what(), folder.path());
  }
  return 0;
}
