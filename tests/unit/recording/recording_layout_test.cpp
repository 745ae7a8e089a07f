#include "recording/recording_layout.h"

#include "frames/calibration_file.h"
#include "unit/recording/made_recording.h"

namespace edgeslam {
namespace {

constexpr std::int64_t largest = 4'000'000'000'000'000'000;

Decision readLine(const std::string& line) {
  EXPECT_EQ(line.find('\n'), line.size() - 1);
  const auto text = undamagedDecision(std::string_view(line).substr(0, line.size() - 1));
  EXPECT_TRUE(text);
  return parseDecision(text.value_or(""), "f:1: ");
}

TEST(RecordingLayout, EveryKindOfLineIsReadAsItWasWritten) {
  const std::vector<Decision> decisions{{DecisionKind::frame, 0, 0, 0, ""},
                                        {DecisionKind::frame, largest, largest, 0, "512 307215 0123abcd"},
                                        {DecisionKind::dropped, 3, 1305031102175304123, 0, ""},
                                        {DecisionKind::unreadable, 7, 5, 0, "a: reason, of  words "},
                                        {DecisionKind::unreadable, 7, 5, 0, ""},
                                        {DecisionKind::update, 12, 0, 4, ""},
                                        {DecisionKind::inertia, 12, 77, 0, "1 2 3 -4e-5 5 9.8"},
                                        {DecisionKind::busy, 8, 0, 0, ""},
                                        {DecisionKind::correction, 9, 0, 2, ""},
                                        {DecisionKind::gap, 0, 0, 17, ""},
                                        {DecisionKind::stopped, 0, 0, 0, "the disk is full"},
                                        {DecisionKind::end, 0, 0, 0, ""}};
  for (const Decision& decision : decisions) {
    const std::string line = formatDecision(decision);
    SCOPED_TRACE(line);
    const Decision read = readLine(line);
    EXPECT_EQ(read.kind, decision.kind);
    EXPECT_EQ(read.index, decision.index);
    EXPECT_EQ(read.time_ns, decision.time_ns);
    EXPECT_EQ(read.number, decision.number);
    EXPECT_EQ(read.text, decision.text);
  }
}

TEST(RecordingLayout, WhereAnImageLiesIsReadAsItWasWritten) {
  for (const ArchivedImage& image :
       {ArchivedImage{512, 307215, 0xFFFFFFFFU}, ArchivedImage{0, 1, 0}, ArchivedImage{largest, largest, 0x1234U}}) {
    const Decision read = readLine(formatDecision(frameDecision(5, 7, image)));
    EXPECT_EQ(read.index, 5);
    EXPECT_EQ(read.time_ns, 7);
    const std::optional<ArchivedImage> back = archivedImageOf(read);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->offset, image.offset);
    EXPECT_EQ(back->size, image.size);
    EXPECT_EQ(back->checksum, image.checksum);
  }
  for (const char* text :
       {"", "1", "1 2", "1 2 0123abc", "1 2 0123abcde", "1 2 0123abcg", "1 2 -123abcd", "1 2 0x23abcd", "-1 2 0123abcd",
        "1 0 0123abcd", "1 -2 0123abcd", "1 2.5 0123abcd", "1 2 0123abcd 4", "1 99999999999999999999 0123abcd"}) {
    EXPECT_FALSE(archivedImageOf({DecisionKind::frame, 5, 7, 0, text})) << text;
  }
  EXPECT_FALSE(archivedImageOf({DecisionKind::unreadable, 5, 7, 0, "1 2 0123abcd"}));
}

TEST(RecordingLayout, ImagesDoNotLieInEachOther) {
  DecisionOrder order;
  EXPECT_EQ(order.add(frameDecision(0, 0, {512, 100, 0})), "");
  EXPECT_NE(order.add(frameDecision(1, 1, {611, 100, 0})).find("611"), std::string::npos);
  EXPECT_NE(order.add(frameDecision(1, 1, {0, 100, 0})), "");
  EXPECT_NE(order.add(frameDecision(0, 1, {5000, 100, 0})), "") << "its index";
  EXPECT_EQ(order.add(frameDecision(1, 1, {612, 100, 0})), "") << "refused ones left the order as it was";
  EXPECT_EQ(order.add(frameDecision(2, 2, {largest, largest, 0})), "");
  EXPECT_NE(order.add(frameDecision(3, 3, {largest, 1, 0})), "");
}

TEST(RecordingLayout, WhatAnInertialUnitMeasuredKeepsItsLastBit) {
  const InertialSample sample{1305031102175304123, {0.1 / 3, -1e-300, 99.99}, {1.0 / 7, 9.80665, -0.0}};
  const Decision read = readLine(formatDecision(inertiaDecision(5, sample)));
  EXPECT_EQ(read.index, 5);
  const std::optional<InertialSample> back = inertialSampleOf(read);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->time_ns, sample.time_ns);
  EXPECT_EQ(back->rate, sample.rate);
  EXPECT_EQ(back->force, sample.force);
  for (const char* text : {"", "1 2 3 4 5", "1 2 3 4 5 6 7", "1 2 3 4 5 nan", "1 2 3 4 5 1e9", "1 2 3 4 5 x"}) {
    EXPECT_FALSE(inertialSampleOf({DecisionKind::inertia, 5, 7, 0, text})) << text;
  }
}

// The checksum of "end" as other programs compute it: python3 -c 'import zlib; print("%08x" % zlib.crc32(b"end"))'
TEST(RecordingLayout, TheChecksumIsTheCustomaryOne) {
  EXPECT_EQ(formatDecision({DecisionKind::end, 0, 0, 0, ""}), "end 00fc33b1\n");
}

TEST(RecordingLayout, AReasonStaysOnItsLine) {
  const std::string reason = std::string("two\nlines\r\t\x7f\x01\0", 15) + std::string(10'000, 'x');
  const Decision read = readLine(formatDecision({DecisionKind::unreadable, 1, 2, 0, reason}));
  EXPECT_EQ(read.text.substr(0, 18), "two lines      xxx");
  EXPECT_EQ(read.text.size(), 500U);
}

TEST(RecordingLayout, AnyOtherByteIsNoticed) {
  std::string line = formatDecision({DecisionKind::frame, 12, 1305031102175304123, 0, ""});
  line.pop_back();
  for (std::size_t i = 0; i < line.size(); ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      std::string flipped = line;
      flipped[i] = static_cast<char>(flipped[i] ^ (1 << bit));
      EXPECT_FALSE(undamagedDecision(flipped)) << flipped;
    }
    EXPECT_FALSE(undamagedDecision(std::string_view(line).substr(0, i)));
    EXPECT_FALSE(undamagedDecision(std::string_view(line).substr(i + 1)));
  }
}

TEST(RecordingLayout, LinesOfOtherFormsAreToldWithTheirPlace) {
  for (const char* text : {"",
                           " ",
                           "frame",
                           "frame 1",
                           "frame -1 2",
                           "frame 1 -2",
                           "frame 1 2.5",
                           "frame 1 0x10",
                           "frame  1 2",
                           "frame 1 99999999999999999999",
                           "frame 4000000000000000001 1",
                           "frame one two",
                           "Frame 1 2",
                           "dropped 1",
                           "dropped 1 2 why",
                           "unreadable 1 why",
                           "update 1",
                           "update 1 nan",
                           "correction 5",
                           "gap",
                           "gap -1",
                           "gap 1 2",
                           "end 1",
                           "end\r",
                           "unreadable 1 2 a\tb",
                           "frames 1 2",
                           "frame 1 +2"}) {
    SCOPED_TRACE(text);
    expectInputError([&] { parseDecision(text, "decisions.txt:7: "); }, "decisions.txt:7: expected", "found '");
  }
  expectInputError([] { parseDecision("unreadable 1 2 " + std::string(501, 'x'), ""); }, "expected");
}

TEST(RecordingLayout, WhatWheelsCannotSayIsNone) {
  const auto poseOf = [](const std::string& text) { return odometryPoseOf({DecisionKind::wheels, 3, 5000, 0, text}); };
  ASSERT_TRUE(poseOf("1 2 3 0.6 0 0.8 0"));
  EXPECT_EQ(poseOf("1 2 3 0.6 0 0.8 0")->utime, 5);
  for (const char* text : {"", "1 2 3", "1 2 3 1 0 0 0 0", "1 2 3 0.6 0 0.7 0", "nan 2 3 1 0 0 0", "1 2 1e8 1 0 0 0",
                           "1 2 3 inf 0 0 0", "1 2 x 1 0 0 0"}) {
    EXPECT_FALSE(poseOf(text)) << text;
  }
  DecisionOrder order;
  EXPECT_EQ(order.add({DecisionKind::wheels, 3, 5000, 0, ""}), "");
  EXPECT_EQ(order.add({DecisionKind::wheels, 3, 6000, 0, ""}), "");
  EXPECT_NE(order.add({DecisionKind::wheels, 2, 7000, 0, ""}), "");
}

TEST(RecordingLayout, DecisionsThatGoBackAreRefusedAndLeaveTheOrderAsItWas) {
  DecisionOrder order;
  const auto add = [&order](DecisionKind kind, std::int64_t index, std::int64_t time_ns, std::int64_t number = 0) {
    return order.add({kind, index, time_ns, number, ""});
  };
  EXPECT_EQ(add(DecisionKind::frame, 0, 0), "");
  EXPECT_EQ(add(DecisionKind::frame, 5, 1000), "");
  EXPECT_NE(add(DecisionKind::frame, 5, 2000), "");
  EXPECT_NE(add(DecisionKind::frame, 6, 1000), "");
  EXPECT_NE(add(DecisionKind::unreadable, 6, 999), "");
  EXPECT_NE(add(DecisionKind::dropped, 4, 2000), "");
  EXPECT_EQ(add(DecisionKind::dropped, 6, 0), "");  // of one that was lost, the time may be unknown
  EXPECT_EQ(add(DecisionKind::unreadable, 7, 1001), "");
  EXPECT_EQ(add(DecisionKind::update, 0, 0, 3), "");
  EXPECT_EQ(add(DecisionKind::update, 0, 0, 4), "");
  EXPECT_NE(add(DecisionKind::update, 1, 0, 4), "");
  EXPECT_EQ(add(DecisionKind::update, 2, 0, 5), "");
  EXPECT_NE(add(DecisionKind::update, 1, 0, 6), "");
  EXPECT_EQ(add(DecisionKind::busy, 2, 0, 0), "");
  EXPECT_NE(add(DecisionKind::busy, 2, 0, 0), "") << "once a frame";
  EXPECT_EQ(add(DecisionKind::correction, 2, 0, 0), "");
  EXPECT_NE(add(DecisionKind::correction, 2, 0, 0), "");
  EXPECT_NE(add(DecisionKind::correction, 1, 0, 1), "");
  for (const std::int64_t value : {std::int64_t{-1}, largest + 1}) {
    EXPECT_NE(add(DecisionKind::frame, value, 5000), "");
    EXPECT_NE(add(DecisionKind::frame, 100, value), "");
    EXPECT_NE(add(DecisionKind::update, 100, 0, value), "");
    EXPECT_NE(add(DecisionKind::gap, 0, 0, value), "");
  }
  EXPECT_EQ(add(DecisionKind::end, 0, 0), "");
  EXPECT_NE(add(DecisionKind::frame, 100, 5000), "");
  EXPECT_NE(add(DecisionKind::stopped, 0, 0), "");
}

TEST(RecordingLayout, TheCameraIsReadBackToTheLastBit) {
  const TemporaryFolder folder;
  for (const CameraModel model : {CameraModel::pinhole_radial_tangential, CameraModel::kannala_brandt}) {
    Camera camera = madeDescription().camera;
    camera.model = model;
    if (model == CameraModel::kannala_brandt) camera.distortion[4] = 0;
    const Camera read = readCalibration(folder.write("camera.yaml", formatCalibrationFile(camera)));
    EXPECT_EQ(read.model, camera.model);
    EXPECT_EQ(read.width, camera.width);
    EXPECT_EQ(read.height, camera.height);
    EXPECT_EQ(read.fx, camera.fx);
    EXPECT_EQ(read.fy, camera.fy);
    EXPECT_EQ(read.cx, camera.cx);
    EXPECT_EQ(read.cy, camera.cy);
    EXPECT_EQ(read.distortion, camera.distortion);
  }
}

}  // namespace
}  // namespace edgeslam
