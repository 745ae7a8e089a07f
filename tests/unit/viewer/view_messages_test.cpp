// What the page is sent, taken apart as the page does.
#include "drivers/viewer/view_messages.h"

#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "unit/map/made_map.h"

namespace edgeslam {
namespace {

using Json = nlohmann::json;

struct TakenApart {
  Json description;
  std::string rest;
};

TakenApart takenApart(const std::string& message, ViewMessage kind) {
  EXPECT_EQ(static_cast<ViewMessage>(message.at(0)), kind);
  std::uint32_t length = 0;
  std::memcpy(&length, message.data() + 1, sizeof(length));
  return {Json::parse(message.substr(5, length)), message.substr(5 + length)};
}

template <typename Number>
Number numberAt(const std::string& bytes, std::size_t at) {
  Number number{};
  std::memcpy(&number, bytes.data() + at, sizeof(number));
  return number;
}

FrameLook madeLook(int width, int height) {
  FrameLook look;
  look.index = 12;
  look.time_ns = 5'000'123'999;
  look.state = TrackingState::tracking;
  look.images = test::madeImages(width, height, 4, 1);
  return look;
}

TEST(ViewMessages, APictureHasItsTracksAndEdges) {
  FrameLook look = madeLook(320, 240);
  look.tracks.push_back({{10.5F, 20.25F}, {11, 21}, {0, 1}, true, true, false});
  look.tracks.push_back({{NAN, -5}, {1e9F, INFINITY}, {NAN, 2}, false, false, true});
  look.edges = {{{1, 2}, 0}, {{3, 4}, 0}, {{5, 6}, 1}};
  const TakenApart picture = takenApart(pictureMessage(look), ViewMessage::picture);
  EXPECT_EQ(picture.description["index"], 12);
  EXPECT_EQ(picture.description["utime"], 5'000'123);
  EXPECT_EQ(picture.description["state"], "tracking");
  EXPECT_EQ(picture.description["width"], 320);
  const std::size_t jpeg_bytes = picture.description["jpeg_bytes"];
  const std::vector<char> jpeg(picture.rest.begin(), picture.rest.begin() + static_cast<std::ptrdiff_t>(jpeg_bytes));
  EXPECT_EQ(cv::imdecode(jpeg, cv::IMREAD_GRAYSCALE).size(), cv::Size(320, 240));
  ASSERT_EQ(picture.description["tracks"], 2);
  ASSERT_EQ(picture.description["edge_points"], 4) << "three, and the end of a line";
  ASSERT_EQ(picture.rest.size(), jpeg_bytes + 2 * 12 + 4 * 4);
  const std::string tracks = picture.rest.substr(jpeg_bytes);
  EXPECT_EQ(numberAt<std::uint16_t>(tracks, 0), 168);
  EXPECT_EQ(numberAt<std::uint16_t>(tracks, 2), 324);
  EXPECT_EQ(numberAt<std::int8_t>(tracks, 9), 127);
  EXPECT_EQ(numberAt<std::uint8_t>(tracks, 10), 3);
  EXPECT_EQ(numberAt<std::uint16_t>(tracks, 12), 0) << "what is not finite is harmless";
  EXPECT_LT(numberAt<std::uint16_t>(tracks, 16), 65535) << "which ends a line";
  EXPECT_EQ(numberAt<std::uint8_t>(tracks, 22), 4);
  EXPECT_EQ(numberAt<std::uint16_t>(tracks, 24), 16);
  EXPECT_EQ(numberAt<std::uint32_t>(tracks, 32), 0xffffffffU);
}

TEST(ViewMessages, AWideImageIsSentSmaller) {
  const TakenApart picture = takenApart(pictureMessage(madeLook(1280, 720)), ViewMessage::picture);
  EXPECT_EQ(picture.description["width"], 1280) << "pixels are those of the whole image";
  const std::vector<char> jpeg(picture.rest.begin(), picture.rest.end());
  EXPECT_EQ(cv::imdecode(jpeg, cv::IMREAD_GRAYSCALE).cols, 640);
  EXPECT_EQ(pictureMessage(FrameLook()), "") << "before the first frame";
}

TEST(ViewMessages, TheStateIsJsonWithFiniteNumbers) {
  ViewedState state;
  const std::string none = stateMessage(state, {});
  EXPECT_TRUE(Json::parse(none.substr(1))["frame"].is_null());

  state.has_frame = true;
  state.frame.state = TrackingState::lost;
  state.frame.reason = "covered \"lens\"\xff";
  state.frame.has_pose = true;
  state.frame.world_T_camera.translation.x() = NAN;
  state.scale = {ScaleKind::odometry, INFINITY, 0.1};
  state.status.camera_problem = "unplugged";
  const Json json = Json::parse(stateMessage(state, {{7, TrackingState::lost, NAN, 2.5}}).substr(1));
  EXPECT_EQ(json["frame"]["state"], "lost");
  EXPECT_TRUE(json["frame"]["pose"].is_null());
  EXPECT_EQ(json["frame"]["world"], -1);
  EXPECT_EQ(json["scale"]["from"], "odometry");
  EXPECT_TRUE(json["scale"]["metres_per_unit"].is_null());
  EXPECT_EQ(json["samples"][0][0], 7);
  EXPECT_TRUE(json["samples"][0][2].is_null());
  EXPECT_EQ(json["samples"][0][3], 2.5);
  EXPECT_EQ(json["status"]["camera_problem"], "unplugged");
}

Json inertiaIn(const ViewedState& state) { return Json::parse(stateMessage(state, {}).substr(1))["frame"]["inertia"]; }

TEST(ViewMessages, UpAndBiasesAreThereOnceTheyAreKnown) {
  ViewedState state;
  state.has_frame = true;
  EXPECT_TRUE(inertiaIn(state).is_null()) << "no unit";
  InertialAlignment& inertia = state.frame.inertia.emplace();
  inertia.gravity = {0, 3, 4};
  inertia.bias = {{0.1, 0.2, 0.3}, {1, 2, 3}};
  EXPECT_TRUE(inertiaIn(state)["up"].is_null());
  EXPECT_TRUE(inertiaIn(state)["bias"].is_null());
  inertia.is_known = inertia.is_bias_known = true;
  EXPECT_EQ(inertiaIn(state)["up"], Json({0.0, -0.6, -0.8}));
  EXPECT_EQ(inertiaIn(state)["bias"]["rate"], Json({0.1, 0.2, 0.3}));
  EXPECT_EQ(inertiaIn(state)["bias"]["force"], Json({1.0, 2.0, 3.0}));
}

}  // namespace
}  // namespace edgeslam
