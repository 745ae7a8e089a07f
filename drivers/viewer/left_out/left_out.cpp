// Stands in for the viewer where it was left out of the build.
#include "drivers/viewer/viewer.h"

namespace edgeslam {

bool viewerIsBuiltIn() { return false; }

// Never made: the constructor throws.
struct Viewer::Work {
  std::string address;
  FrameLooks looks;
};

Viewer::Viewer(const ViewerOptions& /*options*/, const ViewerSetup& /*setup*/, const ViewerPatience& /*patience*/) {
  throw InputError(
      "this program was built without the viewer (build it with EDGESLAM_VIEWER=ON and EDGESLAM_REPORTS=ON)");
}
Viewer::~Viewer() = default;

const std::string& Viewer::address() const { return work_->address; }
bool Viewer::isWatched() const { return false; }
FrameLooks& Viewer::looks() { return work_->looks; }
void Viewer::frame(const FrameResult& /*result*/) {}
void Viewer::status(const PublisherStatus& /*status*/, const ScaleState& /*scale*/, const std::string& /*problem*/) {}
void Viewer::map(std::shared_ptr<const Map> /*map*/, int /*world*/) {}
void Viewer::note(const std::string& /*text*/) {}
std::optional<Command> Viewer::nextCommand() { return std::nullopt; }
void Viewer::answer(const Command& /*command*/, bool /*accepted*/, const std::string& /*message*/) {}

}  // namespace edgeslam
