// `edgeslam map`: what is in a map, two of one place made into one, parts taken out. The sequences are made by ctest
// (see CMakeLists.txt).
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "system/edited_sequence.h"
#include "system/run_result.h"

namespace edgeslam {
namespace {

namespace fs = std::filesystem;

const std::string run_folder = EDGESLAM_RUN_FOLDER;
const std::string hall = run_folder + "/hall", parlour = run_folder + "/parlour",
                  parlour_again = run_folder + "/parlour_again";

class MapCommand : public ::testing::Test {
 protected:
  std::string mapOf(const std::string& sequence, int first, int last, const std::string& name) {
    const std::string edited = EditedSequence(1000).add(sequence, first, last).write(folder_, name + "_frames");
    const ReplayedRun made = replayed(edited, folder_.path(name + "_result"), {"--map-out", path(name)});
    EXPECT_EQ(made.outcome.exit_code, 0) << made.outcome.messages;
    return path(name);
  }
  std::string path(const std::string& name) const { return folder_.path(name); }
  static nlohmann::json infoOf(const std::string& map) {
    const Outcome told = runProgram({"map", "info", map, "--json"});
    EXPECT_EQ(told.exit_code, 0) << told.messages;
    return nlohmann::json::parse(told.output).at(0);
  }
  // Good poses of these frames in a frozen map, and the truth's.
  std::pair<Trajectory, Trajectory> localised(const std::string& map, const std::string& sequence, int first, int last,
                                              double start_s) {
    const std::string name = "localised" + std::to_string(++runs_);
    const std::string edited = EditedSequence(start_s).add(sequence, first, last).write(folder_, name);
    const std::string frozen = folder_.write("frozen.yaml", "map: {frozen: true}\n");
    const ReplayedRun run = replayed(edited, path(name + "_result"), {"--map-in", map, "--config", frozen});
    if (run.outcome.exit_code != 0) return {};
    return {readTrajectory(run.folder + "/trajectory_live.txt"), readTrajectory(edited + "/groundtruth.txt")};
  }
  static void expectRefused(const std::vector<std::string>& arguments, int exit_code, const std::string& text) {
    const Outcome refused = runProgram(arguments);
    EXPECT_EQ(refused.exit_code, exit_code) << text << ": " << refused.messages;
    ASSERT_EQ(refused.failures().size(), 1U) << text << ": " << refused.messages;
    EXPECT_NE(refused.failures()[0].find(text), std::string::npos) << refused.messages;
  }

  const TemporaryFolder folder_;

 private:
  int runs_ = 0;
};

TEST_F(MapCommand, InfoTellsWhatIsInAMapAndDrawsIt) {
  const std::string map = mapOf(hall, 0, 149, "hall.map");
  const nlohmann::json summary = nlohmann::json::parse(fileContent(path("hall.map_result/summary.json")));
  const nlohmann::json info = infoOf(map);
  EXPECT_EQ(info["format_version"], 4);
  EXPECT_EQ(info["bytes"], fs::file_size(map));
  EXPECT_EQ(info["camera"]["width"], 320);
  ASSERT_EQ(info["worlds"].size(), 1U);
  EXPECT_EQ(info["worlds"][0]["keyframes"], summary["keyframes"]);
  EXPECT_EQ(info["worlds"][0]["points"], summary["map_points"]);
  EXPECT_EQ(info["worlds"][0]["lines"], summary["map_lines"]);
  const Outcome told = runProgram({"map", "info", map, map, "--json"});
  EXPECT_EQ(nlohmann::json::parse(told.output).size(), 2U);
  const Outcome drawn = runProgram({"map", "info", map, "--picture", path("hall.png")});
  ASSERT_EQ(drawn.exit_code, 0) << drawn.messages;
  EXPECT_NE(drawn.output.find("keyframes (0 to "), std::string::npos) << drawn.output;
  EXPECT_EQ(fileContent(path("hall.png")).substr(1, 3), "PNG");
  expectRefused({"map", "info", map, "--picture", path("hall.png")}, 2, "is there already");
  EXPECT_EQ(runProgram({"map", "info", map, "--picture", path("hall.png"), "--force"}).exit_code, 0);
  expectRefused({"map", "info", map, map, "--picture", path("two.png")}, 2, "is of one map, 2 are given");
}

// Half of a room and the other half, with something that both have seen: the joined map has both, and is localised in
// all over, in one frame.
TEST_F(MapCommand, TwoPartialMapsOfARoomAreJoined) {
  for (const auto& [sequence, again, error_m] :
       {std::tuple{hall, hall, 0.04}, std::tuple{parlour, parlour_again, 0.12}}) {
    SCOPED_TRACE(sequence);
    const std::string a = mapOf(sequence, 0, 179, "a.map"), b = mapOf(again, 110, 299, "b.map");
    const Outcome joined_maps = runProgram({"map", "join", a, b, "--output", path("both.map"), "--force"});
    ASSERT_EQ(joined_maps.exit_code, 0) << joined_maps.messages;
    const nlohmann::json info = infoOf(path("both.map")), info_a = infoOf(a), info_b = infoOf(b);
    ASSERT_EQ(info["worlds"].size(), 1U);
    EXPECT_EQ(info["worlds"][0]["keyframes"].get<int>(),
              info_a["worlds"][0]["keyframes"].get<int>() + info_b["worlds"][0]["keyframes"].get<int>());
    EXPECT_GT(info["worlds"][0]["points"].get<double>(),
              0.9 * (info_a["worlds"][0]["points"].get<double>() + info_b["worlds"][0]["points"].get<double>()));
    const auto [early, early_truth] = localised(path("both.map"), sequence, 20, 109, 2000);
    const auto [late, late_truth] = localised(path("both.map"), sequence, 190, 279, 3000);
    EXPECT_GE(early.size(), 70U);
    EXPECT_GE(late.size(), 70U);
    EXPECT_LT(largestError(joined(early, late), joined(early_truth, late_truth)), error_m);
    for (const char* name : {"a.map", "b.map"}) {
      fs::remove_all(path(std::string(name) + "_frames"));
      fs::remove_all(path(std::string(name) + "_result"));
    }
  }
}

TEST_F(MapCommand, MapsOfTwoPlacesOrTwoCamerasAreNotJoined) {
  const std::string a = mapOf(hall, 0, 99, "hall.map"), b = mapOf(parlour, 0, 99, "parlour.map");
  expectRefused({"map", "join", a, b, "--output", path("both.map")}, 1, "no place of it is found in the other maps: ");
  EXPECT_FALSE(fs::exists(path("both.map")));
  expectRefused({"map", "join", a, a, "--output", path("both.map")}, 2, "is given twice");

  const std::string frames = EditedSequence(1000).add(hall, 0, 99).write(folder_, "other_camera");
  std::string calibration = fileContent(frames + "/camera.yaml");
  calibration += "readout: 0.001\n";
  folder_.write("other_camera/camera.yaml", calibration);
  const ReplayedRun other = replayed(frames, path("other_result"), {"--map-out", path("other.map")});
  ASSERT_EQ(other.outcome.exit_code, 0) << other.outcome.messages;
  expectRefused({"map", "join", a, path("other.map"), "--output", path("both.map")}, 2,
                "was made with another calibration than " + a + ": its readout is 0.001, the other's is 0");
  EXPECT_FALSE(fs::exists(path("both.map")));
}

// What is cut away is not found any more, what stays is, where it was.
TEST_F(MapCommand, CropTakesPartsOut) {
  const std::string map = mapOf(hall, 0, 299, "hall.map");
  const nlohmann::json whole = infoOf(map)["worlds"][0];
  const int last = whole["last_keyframe"];
  const std::string half = std::to_string(last / 2) + ":" + std::to_string(last);
  const Outcome cropped = runProgram({"map", "crop", map, "--output", path("half.map"), "--remove-keyframes", half});
  ASSERT_EQ(cropped.exit_code, 0) << cropped.messages;
  const nlohmann::json left = infoOf(path("half.map"))["worlds"][0];
  EXPECT_LT(left["last_keyframe"].get<int>(), last / 2);
  EXPECT_LT(left["points"], whole["points"]);
  EXPECT_EQ(left["cameras"]["least"].size(), 3U);
  const auto [in_whole, whole_truth] = localised(map, hall, 20, 59, 2000);
  const auto [in_half, half_truth] = localised(path("half.map"), hall, 20, 59, 3000);
  ASSERT_GE(in_half.size(), 30U);
  EXPECT_LT(largestError(joined(in_whole, in_half), joined(whole_truth, half_truth)), 0.02) << "coordinates stay";

  const double middle =
      0.5 * (whole["most_points"]["least"][0].get<double>() + whole["most_points"]["most"][0].get<double>());
  const std::string right = std::to_string(middle) + ":,:,:";
  ASSERT_EQ(runProgram({"map", "crop", map, "--output", path("left.map"), "--remove-box", right}).exit_code, 0);
  EXPECT_LE(infoOf(path("left.map"))["worlds"][0]["most_points"]["most"][0].get<double>(), middle);
  const std::string left_side = ":" + std::to_string(middle) + ",:,:";
  ASSERT_EQ(runProgram({"map", "crop", map, "--output", path("kept.map"), "--keep-box", left_side}).exit_code, 0);
  EXPECT_LE(infoOf(path("kept.map"))["worlds"][0]["most_points"]["most"][0].get<double>(), middle);
}

TEST_F(MapCommand, CropSaysWhatIsWrong) {
  const std::string map = mapOf(hall, 0, 60, "hall.map"), output = path("out.map");
  const std::string before = fileContent(map);
  const auto refused = [&](std::vector<std::string> options, const std::string& text) {
    std::vector<std::string> arguments{"map", "crop", map, "--output", output};
    arguments.insert(arguments.end(), options.begin(), options.end());
    expectRefused(arguments, 2, text);
  };
  refused({}, "what is to be taken out?");
  refused({"--remove-box", "1:2"}, "has not three ranges");
  refused({"--keep-box", "2:1,:,:"}, "ends before it begins");
  refused({"--remove-keyframes", "9:3"}, "the last one comes before the first");
  refused({"--remove-map", "4"}, "has no map 4");
  refused({"--remove-box", "1000:,:,:"}, "nothing of it lies there");
  refused({"--remove-map", "0"}, "nothing would be left of it");
  EXPECT_FALSE(fs::exists(output));
  expectRefused({"map", "crop", map, "--output", map, "--remove-keyframes", "0"}, 2, "is there already");
  EXPECT_TRUE(fileContent(map) == before);
  expectRefused({"map"}, 2, "subcommand is required");
  expectRefused({"map", "join", map, "--output", output}, 2, "see edgeslam map --help");
}

// The bytes from 28 on, but for the checksum in the last four, changed and the checksum made right again.
std::string withDouble(std::string bytes, std::size_t place, double value) {
  std::memcpy(&bytes[place], &value, sizeof value);
  const std::size_t end = bytes.size() - 4;
  const auto sum = static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), end));
  for (std::size_t i = 0; i < 4; ++i) bytes[end + i] = static_cast<char>(sum >> (8 * i) & 0xFF);
  return bytes;
}

TEST_F(MapCommand, HostileFilesAreRefusedByEachOfThem) {
  const std::string map = mapOf(hall, 0, 60, "hall.map"), whole = fileContent(map);
  const std::size_t fx = 16 + 4 + 8 + 4 + 8 + 4 + 4 + 4;  // magic, version, length; section, length; model, sides
  const std::vector<std::pair<std::string, std::string>> hostile{
      {folder_.write("empty.map", ""), "is cut off"},
      {folder_.write("notes.map", "a shopping list"), "is not a map saved by edgeslam"},
      {folder_.write("cut.map", whole.substr(0, whole.size() / 2)), "is cut off"},
      {folder_.write("flipped.map",
                     [&] {
                       std::string flipped = whole;
                       flipped[whole.size() / 3] = static_cast<char>(flipped[whole.size() / 3] ^ 4);
                       return flipped;
                     }()),
       "is damaged"},
      {folder_.write("nan.map", withDouble(whole, fx, std::numeric_limits<double>::quiet_NaN())), "focal length"},
      {path("missing.map"), "no such file"},
      {folder_.path(), "this is no file"}};
  for (const auto& [file, text] : hostile) {
    expectRefused({"map", "info", file}, 2, text);
    expectRefused({"map", "join", map, file, "--output", path("out.map")}, 2, text);
    expectRefused({"map", "join", file, map, "--output", path("out.map")}, 2, text);
    expectRefused({"map", "crop", file, "--output", path("out.map"), "--remove-keyframes", "0"}, 2, text);
  }
  EXPECT_FALSE(fs::exists(path("out.map")));
  expectRefused({"map", "join", map, map + "2", "--output", "/nowhere/out.map"}, 2, "cannot be saved there");
}

}  // namespace
}  // namespace edgeslam
