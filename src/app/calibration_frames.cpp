#include "app/calibration_frames.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <utility>

#include "calibration/calibration.h"
#include "calibration/coverage.h"
#include "files/format_text.h"
#include "frames/folder_source.h"
#include "recording/open_frame_source.h"

namespace edgeslam {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t views_to_an_error = 5;  // between two fits on the way
constexpr std::int64_t silence_ns = 4'000'000'000;

// What is said while views are taken.
class Guide {
 public:
  Guide(const Board& board, const TellLine& tell) : board_(board), tell_(tell) {}

  void afterView(const ViewSelection& selection) {
    const ViewCoverage coverage = coverageOf(selection.views(), selection.imageSize());
    if (selection.views().size() % views_to_an_error == 0) {
      const std::optional<double> error = quickError(selection.views(), board_, selection.imageSize());
      error_ = error ? formatted(", error so far %.2f px", *error) : "";
    }
    tell_(formatted("view %d: %.0f %% of the image covered", coverage.views, 100 * coverage.share()) + error_);
    const std::vector<std::string> wishes = missingViews(coverage);
    if (!wishes.empty() && wishes.front() != wish_) tell_("  next: " + wishes.front());
    wish_ = wishes.empty() ? "" : wishes.front();
  }

  void afterNoView(ViewDecision decision, std::int64_t time_ns) {
    const char* why = reason(decision);
    if (why == nullptr || time_ns - told_ns_ < silence_ns) return;
    told_ns_ = time_ns;
    tell_(std::string("  ") + why + (wish_.empty() ? "" : "; wanted: " + wish_));
  }

  void viewAt(std::int64_t time_ns) { told_ns_ = time_ns; }

 private:
  static const char* reason(ViewDecision decision) {
    switch (decision) {
      case ViewDecision::no_board:
        return "the board is not found: all of a chessboard must be in the image, lit evenly";
      case ViewDecision::blurred:
        return "the board is not sharp: hold it still, focus, or give more light";
      case ViewDecision::moving:
        return "the board moves: hold it still for a moment";
      case ViewDecision::not_new:
        return "such a view is there already: move or tilt the board";
      default:
        return nullptr;
    }
  }

  Board board_;
  const TellLine& tell_;
  std::string wish_, error_;
  std::int64_t told_ns_ = 0;
};

void tellDecision(ViewDecision decision, std::int64_t time_ns, const ViewSelection& selection, Guide& guide) {
  if (decision == ViewDecision::taken) {
    guide.viewAt(time_ns);
    guide.afterView(selection);
  } else {
    guide.afterNoView(decision, time_ns);
  }
}

// True where a file says what the folder's frames are.
bool isListed(const fs::path& folder) {
  std::error_code error;
  for (const char* name : {"rgb.txt", "associations.txt", "recording.txt", "data.csv", "times.txt"}) {
    if (fs::exists(folder / name, error)) return true;
  }
  return false;
}

}  // namespace

std::unique_ptr<FrameSource> openStillsOrFrames(const std::string& path) {
  std::error_code error;
  if (!fs::is_directory(path, error) || isListed(path)) return openFrameSource(path);
  std::vector<std::string> images;
  bool has_times = true;
  for (const fs::directory_entry& entry : fs::directory_iterator(path, error)) {
    if (!entry.is_regular_file(error) || !isImageFileName(entry.path().filename().string())) continue;
    images.push_back(entry.path().string());
  }
  try {
    if (!images.empty()) imagesNamedByTime(path);
  } catch (const InputError&) {
    has_times = false;
  }
  if (images.empty() || has_times) return openFrameSource(path);
  std::sort(images.begin(), images.end());
  std::vector<StampedFile> files;
  constexpr std::int64_t apart_ns = 1'000'000'000;
  for (const std::string& image : images) {
    files.push_back({static_cast<std::int64_t>(files.size()) * apart_ns, image});
  }
  return makeFolderSource("folder of stills", std::move(files), {});
}

void takeViews(FrameSource& source, const Board& board, ViewSelection& selection, const TellLine& tell) {
  Guide guide(board, tell);
  std::int64_t frames = 0, unreadable = 0;
  std::string problem;
  while (const std::optional<Frame> frame = source.next()) {
    ++frames;
    if (frame->grey.empty()) {
      if (unreadable++ == 0) tell("frame " + std::to_string(frame->index) + " left out: " + (problem = frame->problem));
      continue;
    }
    tellDecision(selection.add(frame->index, frame->time_ns, frame->grey), frame->time_ns, selection, guide);
  }
  if (5 * unreadable > frames) {
    throw InputError(std::to_string(unreadable) + " of " + std::to_string(frames) +
                     " frames cannot be used: " + problem);
  }
  selection.end();
}

void takeViews(LiveCamera& camera, const Board& board, double seconds, ViewSelection& selection,
               const std::function<bool()>& stop, const TellLine& tell) {
  Guide guide(board, tell);
  std::int64_t first_ns = -1;
  bool is_complete = false;
  while (!is_complete && !stop()) {
    cv::Mat grey;
    const Capture capture = camera.next(grey, std::chrono::milliseconds(100));
    if (capture.event == CaptureEvent::ended) break;
    if (capture.event == CaptureEvent::interrupted) tell(capture.message);
    if (capture.event != CaptureEvent::frame) continue;
    const std::int64_t time_ns = capture.frame.time_ns;
    if (first_ns < 0) first_ns = time_ns;
    if (seconds > 0 && static_cast<double>(time_ns - first_ns) * 1e-9 >= seconds) break;
    const ViewDecision decision = selection.add(capture.frame.sequence, time_ns, grey);
    tellDecision(decision, time_ns, selection, guide);
    is_complete =
        decision == ViewDecision::taken && missingViews(coverageOf(selection.views(), selection.imageSize())).empty();
  }
  selection.end();
}

}  // namespace edgeslam
