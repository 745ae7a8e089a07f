#include "service/next_recording.h"

#include "unit/files/temporary_folder.h"
#include "unit/lcm/comes_true.h"
#include "unit/service/made_service.h"

namespace edgeslam {
namespace {

Command commandTo(CommandKind kind) {
  Command command;
  command.id = 5;
  command.kind = kind;
  return command;
}

class NextRecordingTest : public MadeService {
 protected:
  NextRecordingTest() { configuration_.service.recordings_folder = folder_.path("recordings"); }

  // Until the disk has answered.
  std::optional<Command> prepared(NextRecording& next) {
    EXPECT_TRUE(comesTrue([&] {
      next.seeToPreparation();
      return !next.isUnderway();
    }));
    return next.takePrepared();
  }

  TemporaryFolder folder_;
  Configuration configuration_;
  Camera camera_ = smallCamera();
  CaptureLink link_;
};

TEST_F(NextRecordingTest, ARunThatIsNotRecordedBeginsAnewAtOnce) {
  NextRecording next(configuration_, camera_, link_, log_);
  next.prepareFor(commandTo(CommandKind::reset));
  EXPECT_FALSE(next.isUnderway());
  EXPECT_TRUE(next.takePrepared());
  EXPECT_FALSE(next.takePrepared()) << "once";
  EXPECT_EQ(next.take(), nullptr);
}

TEST_F(NextRecordingTest, IsOpenedForACommandInTheBackground) {
  NextRecording next(configuration_, camera_, link_, log_);
  next.prepareFor(commandTo(CommandKind::start_recording));
  EXPECT_TRUE(next.isUnderway());
  const std::optional<Command> command = prepared(next);
  ASSERT_TRUE(command);
  EXPECT_EQ(command->kind, CommandKind::start_recording);
  ASSERT_TRUE(next.isOpen());
  EXPECT_TRUE(std::filesystem::exists(next.folder()));
  EXPECT_NE(next.take(), nullptr);
  EXPECT_FALSE(next.isOpen());
}

TEST_F(NextRecordingTest, ACommandThatCannotBeCarriedOutIsAnswered) {
  configuration_.service.recordings_folder.clear();
  NextRecording next(configuration_, camera_, link_, log_);
  next.prepareFor(commandTo(CommandKind::start_recording));
  EXPECT_FALSE(prepared(next));
  const std::vector<CaptureLink::Answer> answers = link_.takeAnswers();
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_FALSE(answers[0].accepted);
  EXPECT_EQ(answers[0].message, "no folder is configured for recordings (recording.folder)");
}

TEST_F(NextRecordingTest, ADiskThatDoesNotTakeItIsNoReasonNotToBeginAnew) {
  configuration_.service.records_from_start = true;
  configuration_.service.recordings_folder = folder_.write("a_file", "");
  NextRecording next(configuration_, camera_, link_, log_);
  next.openWhereConfigured();
  EXPECT_FALSE(next.isOpen());
  EXPECT_EQ(said().rfind("edgeslam: no recording: ", 0), 0U);
  next.prepareFor(commandTo(CommandKind::reset));
  EXPECT_TRUE(prepared(next));
  EXPECT_FALSE(next.isOpen());
  EXPECT_TRUE(link_.takeAnswers().empty()) << "it is answered when it was carried out";
}

}  // namespace
}  // namespace edgeslam
