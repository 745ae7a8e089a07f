#include "service/run_recording.h"

#include <algorithm>

#include "unit/files/temporary_folder.h"
#include "unit/service/made_service.h"

namespace edgeslam {
namespace {

class RunRecordingTest : public MadeService {
 protected:
  std::shared_ptr<FlightRecorder> recorder() const {
    const RecordingDescription description{smallCamera(), "", "0.1.0"};
    return std::make_shared<FlightRecorder>(folder_.path("recording"), description);
  }

  TemporaryFolder folder_;
  RunRecording recording_{answers_, work_, log_};
};

TEST_F(RunRecordingTest, ARunThatIsNotRecordedHasNothingToTell) {
  recording_.begin(nullptr);
  EXPECT_FALSE(recording_.goesOn());
  EXPECT_FALSE(recording_.hasGaps());
  recording_.tellChanges(false);
  recording_.stop(Command());
  recording_.end();
  finishWork();
  EXPECT_EQ(said(), "");
}

TEST_F(RunRecordingTest, EndsWithItsRunAndIsToldOnce) {
  recording_.begin(recorder());
  EXPECT_TRUE(recording_.goesOn());
  recording_.tellChanges(true);
  recording_.end();
  finishWork();
  recording_.tellChanges(false);
  const std::string told = said();
  EXPECT_EQ(told.rfind("edgeslam: ", 0), 0U);
  EXPECT_EQ(std::count(told.begin(), told.end(), '\n'), 1) << told;
}

TEST_F(RunRecordingTest, ACommandEndsItWhileTheRunGoesOn) {
  recording_.begin(recorder());
  recording_.stop(Command());
  EXPECT_FALSE(recording_.goesOn());
  finishWork();
  recording_.end();
  finishWork();
  const std::string told = said();
  EXPECT_EQ(std::count(told.begin(), told.end(), '\n'), 1) << told;
}

TEST_F(RunRecordingTest, AnEndThatNobodyAskedForIsTold) {
  const std::shared_ptr<FlightRecorder> ended = recorder();
  recording_.begin(ended);
  const std::string message = ended->stop().message;
  recording_.tellChanges(recording_.goesOn());
  recording_.tellChanges(recording_.goesOn());
  EXPECT_EQ(said(), "edgeslam: " + message + "\n");
}

}  // namespace
}  // namespace edgeslam
