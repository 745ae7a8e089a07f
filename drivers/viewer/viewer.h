// A page in the browser for people who look on: what the camera sees with edges and tracks, the map, state and figures,
// and buttons for the robot's commands. In a thread of its own, newest data only; while nobody looks on, all that it
// costs the run is an atomic a frame.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "drivers/lcm/commands.h"
#include "drivers/viewer/view_messages.h"
#include "drivers/viewer/viewer_options.h"
#include "edgeslam/input_error.h"
#include "map/map.h"

namespace edgeslam {

// False where it was left out of the build (EDGESLAM_VIEWER=OFF).
bool viewerIsBuiltIn();

// All functions but looks(), isWatched() and address() are for one thread at a time, the publishing one. None waits.
class Viewer {
 public:
  // Serves from here on. Throws InputError where it cannot, and where it was left out.
  Viewer(const ViewerOptions& options, const ViewerSetup& setup, const ViewerPatience& patience = {});
  ~Viewer();
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  // "http://127.0.0.1:8417/", without the token.
  const std::string& address() const;
  bool isWatched() const;
  // For LiveRun::showTo().
  FrameLooks& looks();

  // Each frame, in order.
  void frame(const FrameResult& result);
  // Each second, and after what changes it.
  void status(const PublisherStatus& status, const ScaleState& scale, const std::string& lcm_problem);
  // Shown of it is this world alone.
  void map(std::shared_ptr<const Map> map, int world);
  // A line for the person who looks on, until the next; empty: none.
  void note(const std::string& text);

  // The oldest command that was not handed out yet; each is to be answered once.
  std::optional<Command> nextCommand();
  void answer(const Command& command, bool accepted, const std::string& message);

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace edgeslam
