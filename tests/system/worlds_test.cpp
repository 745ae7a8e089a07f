// A camera that is lost in a place not seen before: it begins a world there, comes back to the one before, and two
// worlds that are one place are joined. The sequences are made by ctest (see CMakeLists.txt).
#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "system/edited_sequence.h"
#include "system/run_result.h"

namespace edgeslam {
namespace {

std::string place(const std::string& name) { return std::string(EDGESLAM_RUN_FOLDER) + "/" + name; }

class Worlds : public ::testing::Test {
 protected:
  ReplayedRun run(const EditedSequence& edited, const std::string& name = "result",
                  const std::vector<std::string>& more = {}) {
    sequence_ = edited.write(folder_, name + "_sequence");
    ReplayedRun result = replayed(sequence_, folder_.path(name), more);
    EXPECT_EQ(result.outcome.exit_code, 0) << result.outcome.messages;
    return result;
  }
  double errorOf(const ReplayedRun& result, const std::string& trajectory) const {
    return largestError(readTrajectory(result.folder + "/" + trajectory),
                        readTrajectory(sequence_ + "/groundtruth.txt"));
  }

  const TemporaryFolder folder_;
  std::string sequence_;
};

// Through the dark into another room and back. `first_in`: of the frames in the other room.
constexpr int dark = 60, first_in = 150 + dark, last_in = first_in + 199, first_back = last_in + 1 + dark;

EditedSequence twoRooms() {
  return EditedSequence()
      .add(place("parlour"), 0, 149)
      .addBlack(dark)
      .add(place("hall"), 0, 199)
      .addBlack(dark)
      .add(place("parlour"), 149, 60);
}

TEST_F(Worlds, AnotherRoomIsAnotherWorldAndTheFirstOneIsFoundAgain) {
  const ReplayedRun result = run(twoRooms());
  const int last = static_cast<int>(result.states.size()) - 1;
  for (int frame = 0; frame <= last; ++frame) {
    const int world = result.worlds[static_cast<std::size_t>(frame)];
    if (result.countGood(frame, frame) == 0) continue;
    EXPECT_EQ(world, frame >= first_in && frame <= last_in ? 1 : 0) << frame;
  }
  // Both rooms are seen for long enough to have poses nearly all the time.
  EXPECT_GT(result.countGood(first_in, last_in), 150);
  EXPECT_GT(result.countGood(first_back, last), 80);
  EXPECT_LT(errorOf(result, "trajectory.txt"), 0.05);
  EXPECT_LT(errorOf(result, "trajectory_map1.txt"), 0.05);
  EXPECT_FALSE(std::filesystem::exists(result.folder + "/trajectory_map2.txt"));
}

TEST_F(Worlds, TheSameFramesGiveTheSameBytesTwice) {
  const ReplayedRun once = run(twoRooms(), "once"), again = run(twoRooms(), "again");
  for (const char* file :
       {"trajectory.txt", "trajectory_live.txt", "trajectory_map1.txt", "map.ply", "keyframes.txt"}) {
    const std::string bytes = fileContent(once.folder + "/" + file);
    EXPECT_FALSE(bytes.empty()) << file;
    EXPECT_EQ(bytes, fileContent(again.folder + "/" + file)) << file;
  }
}

// It is lost at one end of the hall and begins anew at the other, from where it goes back.
TEST_F(Worlds, AreJoinedWhereTheyMeet) {
  const ReplayedRun result =
      run(EditedSequence().add(place("hall"), 0, 110).addBlack(dark).add(place("hall"), 299, 40));
  const int last = static_cast<int>(result.states.size()) - 1;
  EXPECT_EQ(result.worlds[100], 0);
  EXPECT_EQ(result.worlds[static_cast<std::size_t>(last)], 0);
  EXPECT_FALSE(std::filesystem::exists(result.folder + "/trajectory_map1.txt")) << result.outcome.messages;
  EXPECT_LT(errorOf(result, "trajectory.txt"), 0.08);
}

TEST_F(Worlds, NoneIsBegunWhereTheyAreSwitchedOff) {
  folder_.write("one.yaml", "tracking: {new_map: false}\n");
  const ReplayedRun result = run(twoRooms(), "result", {"--config", folder_.path("one.yaml")});
  EXPECT_EQ(result.countGood(first_in, last_in), 0);
  for (const int world : result.worlds) EXPECT_LE(world, 0);
}

// A map of two worlds is saved and read again, and the camera found in either.
TEST_F(Worlds, ASavedMapKeepsThem) {
  const std::string map = folder_.path("two.map");
  const ReplayedRun first = run(twoRooms(), "first", {"--map-out", map});
  const ReplayedRun second = run(EditedSequence(2000).add(place("hall"), 60, 120), "second", {"--map-in", map});
  const int found = second.firstGood(0);
  ASSERT_GE(found, 0);
  EXPECT_LE(found, 15);
  EXPECT_EQ(second.worlds[static_cast<std::size_t>(found)], 1);
  const ReplayedRun third = run(EditedSequence(2000).add(place("parlour"), 60, 120), "third", {"--map-in", map});
  ASSERT_GE(third.firstGood(0), 0);
  EXPECT_EQ(third.worlds[static_cast<std::size_t>(third.firstGood(0))], 0);
}

TEST_F(Worlds, BesideASavedMapThatIsNeverFoundOneIsBegun) {
  const std::string map = folder_.path("parlour.map");
  run(EditedSequence().add(place("parlour"), 0, 149), "first", {"--map-out", map});
  const ReplayedRun result = run(EditedSequence(2000).add(place("hall"), 0, 199), "second", {"--map-in", map});
  const int found = result.firstGood(0);
  ASSERT_GE(found, 0);
  EXPECT_LE(found, 90);
  EXPECT_EQ(result.worlds[static_cast<std::size_t>(found)], 1);
  EXPECT_NE(result.outcome.output.find("map 1 begins"), std::string::npos) << result.outcome.output;
}

// Covers, jumps and turns at random: once the camera can see, it has a pose within three seconds.
TEST_F(Worlds, NeverLostForLong) {
  std::mt19937 random(7);
  const auto below = [&](int bound) { return static_cast<int>(random() % static_cast<unsigned>(bound)); };
  const std::vector<std::string> places{"hall", "parlour", "bare"};
  EditedSequence walk;
  std::vector<char> can_see;
  for (int stretch = 0; stretch < 10; ++stretch) {
    const int first = below(150), length = 90 + below(60);
    walk.add(place(places[random() % places.size()]), first, first + length - 1);
    can_see.insert(can_see.end(), static_cast<std::size_t>(length), 1);
    const int black = stretch % 3 == 0 ? 0 : 5 + below(60);  // without it the camera jumps
    walk.addBlack(black);
    can_see.insert(can_see.end(), static_cast<std::size_t>(black), 0);
  }
  const ReplayedRun result = run(walk);
  ASSERT_EQ(result.states.size(), can_see.size());
  int without = 0, longest = 0;
  for (std::size_t frame = 0; frame < can_see.size(); ++frame) {
    const auto index = static_cast<int>(frame);
    without = !can_see[frame] || result.countGood(index, index) > 0 ? 0 : without + 1;
    longest = std::max(longest, without);
  }
  EXPECT_LE(longest, 90);
}

}  // namespace
}  // namespace edgeslam
