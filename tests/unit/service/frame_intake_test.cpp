#include "service/frame_intake.h"

#include "unit/service/made_service.h"

namespace edgeslam {
namespace {

class FrameIntakeTest : public MadeService {
 protected:
  void take(CaptureEvent event, std::int64_t sequence = 0, std::int64_t time_ns = 0, const std::string& message = "") {
    Capture captured;
    captured.event = event;
    captured.frame.sequence = sequence;
    captured.frame.time_ns = time_ns;
    captured.message = message;
    intake_.take(captured, run_);
  }

  // One that is not there.
  ReopeningCamera camera_{[] { return OpenedCamera(); }, StreamDescription(), "not there"};
  CaptureLink link_;
  FrameIntake intake_{camera_, link_, log_};
};

TEST_F(FrameIntakeTest, FramesAreHandedOverWithNumbersThatGrow) {
  for (const std::int64_t sequence : {0, 3, 3, 2}) take(CaptureEvent::frame, sequence, 1000 + sequence);
  EXPECT_EQ(run_.counts().captured, 4);
  take(CaptureEvent::none_yet);
  EXPECT_EQ(run_.counts().captured, 4);
  EXPECT_EQ(link_.waits(), 1) << "there is no camera to wait for";
}

TEST_F(FrameIntakeTest, DamagedFramesAreToldOnceAndThoseWithoutATimeOnlyCounted) {
  take(CaptureEvent::frame, 0, 1000);
  take(CaptureEvent::damaged_frame, 1, 2000, "torn");
  take(CaptureEvent::damaged_frame, 2, 2000, "torn");
  EXPECT_EQ(run_.counts().captured, 2);
  EXPECT_EQ(link_.lost(), 1);
  EXPECT_EQ(said(), "edgeslam: torn (more of them are only counted)\n");
}

TEST_F(FrameIntakeTest, AnInterruptionIsToldAndKeptAsTheReasonWhyNoFramesCome) {
  take(CaptureEvent::interrupted, 0, 0, "the camera is gone");
  EXPECT_EQ(link_.cameraProblem(), "the camera is gone");
  EXPECT_EQ(said(), "edgeslam: the camera is gone\n");
}

}  // namespace
}  // namespace edgeslam
