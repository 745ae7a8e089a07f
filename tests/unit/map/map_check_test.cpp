// What is wrong with a map is named.
#include "map/map_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "edgeslam/input_error.h"
#include "unit/map/change_each.h"
#include "unit/map/made_map.h"

namespace edgeslam {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::int64_t far_off = std::numeric_limits<std::int64_t>::max();

struct Change {
  const char* where;  // what the message begins with
  const char* what;   // and holds
  std::function<void(SavedMap&)> make;
};

// The map is put into a file whose checksum fits, and must be refused for this very change.
void expectRefused(const std::vector<Change>& changes) {
  for (const Change& change : changes) {
    SavedMap saved = test::madeMap(32, 24);
    ASSERT_NO_THROW(decodeMap(encodeMap(saved), "hall.map"));
    change.make(saved);
    try {
      decodeMap(encodeMap(saved), "hall.map");
      ADD_FAILURE() << change.where << ": " << change.what << ": accepted";
    } catch (const InputError& error) {
      const std::string told = error.what();
      EXPECT_NE(told.find(change.where), std::string::npos) << told;
      EXPECT_NE(told.find(change.what), std::string::npos) << told;
    }
  }
}

MapPoint& pointOf(SavedMap& saved, PointId id) { return saved.map.points.at(id); }

// Changes what keyframe 4 saw of its second point.
template <typename Change>
void changeObservation(SavedMap& saved, const Change& change) {
  int place = 0;
  test::changeEach(test::keyframeOf(saved, 4).observations, [&](PointObservation& seen) {
    if (place++ == 1) change(seen);
  });
}

TEST(MapCheck, AMadeMapKeepsToTheRules) {
  const SavedMap saved = test::madeMap(32, 24);
  EXPECT_EQ(cameraProblem(saved.camera), "");
  EXPECT_EQ(mapProblem(saved.camera, saved.map), "");
  EXPECT_EQ(mapProblem(saved.camera, Map()), "");
}

TEST(MapCheck, Cameras) {
  expectRefused({
      {"camera: ", "model", [](SavedMap& s) { s.camera.model = static_cast<CameraModel>(2); }},
      {"camera: ", "images of 0 x 24", [](SavedMap& s) { s.camera.width = 0; }},
      {"camera: ", "images of 32 x -24", [](SavedMap& s) { s.camera.height = -24; }},
      {"camera: ", "images of 32 x 32769", [](SavedMap& s) { s.camera.height = 32769; }},
      {"camera: ", "focal length", [](SavedMap& s) { s.camera.fx = 0; }},
      {"camera: ", "focal length", [](SavedMap& s) { s.camera.fy = not_a_number; }},
      {"camera: ", "principal point", [](SavedMap& s) { s.camera.cx = infinity; }},
      {"camera: ", "principal point", [](SavedMap& s) { s.camera.cy = not_a_number; }},
      {"camera: ", "distortion", [](SavedMap& s) { s.camera.distortion[4] = not_a_number; }},
      {"camera: ", "readout", [](SavedMap& s) { s.camera.readout_s = not_a_number; }},
      {"camera: ", "readout", [](SavedMap& s) { s.camera.readout_s = infinity; }},
      {"camera: ", "readout", [](SavedMap& s) { s.camera.readout_s = 0.201; }},
      {"camera: ", "readout", [](SavedMap& s) { s.camera.readout_s = -0.201; }},
  });
}

TEST(MapCheck, Keyframes) {
  const auto keyframe = [](SavedMap& s) -> Keyframe& { return test::keyframeOf(s, 4); };
  expectRefused({
      {"keyframe 1 ", "comes after 1", [](SavedMap& s) { s.map.keyframes.begin()->id = 1; }},
      {"keyframe 1 ", "comes after 8", [](SavedMap& s) { s.map.keyframes.begin()->id = 8; }},
      {"keyframe -1: ", "numbers go from 0", [](SavedMap& s) { s.map.keyframes.begin()->id = -1; }},
      {"keyframe 16777216: ", "numbers go", [](SavedMap& s) { s.map.keyframes.back().id = largest_keyframe_id + 1; }},
      {"keyframe 4: ", "frame or time", [&](SavedMap& s) { keyframe(s).frame_index = -1; }},
      {"keyframe 4: ", "frame or time", [&](SavedMap& s) { keyframe(s).time_ns = far_off; }},
      {"keyframe 4: ", "frame or time", [&](SavedMap& s) { keyframe(s).time_ns = -far_off; }},
      {"keyframe 4: ", "unit quaternion", [&](SavedMap& s) { keyframe(s).world_T_camera.rotation.w() *= 1.001; }},
      {"keyframe 4: ", "unit quaternion", [&](SavedMap& s) { keyframe(s).world_T_camera.rotation.x() = not_a_number; }},
      {"keyframe 4: ", "position", [&](SavedMap& s) { keyframe(s).world_T_camera.translation.z() = -infinity; }},
      {"keyframe 4: ", "position", [&](SavedMap& s) { keyframe(s).world_T_camera.translation.y() = 1e300; }},
      {"keyframe 4: ", "motion", [&](SavedMap& s) { keyframe(s).twist(0) = not_a_number; }},
      {"keyframe 4: ", "motion", [&](SavedMap& s) { keyframe(s).twist(2) = 1e300; }},
      {"keyframe 4: ", "motion", [&](SavedMap& s) { keyframe(s).twist(5) = -infinity; }},
      {"keyframe 4: ", "reason", [&](SavedMap& s) { keyframe(s).reason = "\x1b[2J"; }},
      {"keyframe 4: ", "reason", [&](SavedMap& s) { keyframe(s).reason = "\xC3("; }},
      {"keyframe 4: ", "images' frame or time",
       [&](SavedMap& s) {
         auto images = test::madeImages(32, 24, 2, 4);
         images->time_ns = far_off;
         keyframe(s).images = images;
       }},
  });
}

TEST(MapCheck, Observations) {
  const char* const where = "keyframe 4: observation of point 3: ";
  expectRefused({
      {"keyframe 4: observation of point 2: ", "comes after",
       [](SavedMap& s) { changeObservation(s, [](PointObservation& o) { o.point = 2; }); }},
      {"keyframe 4: observation of point -7: ", "no such",
       [](SavedMap& s) { changeObservation(s, [](PointObservation& o) { o.point = -7; }); }},
      {"keyframe 4: observation of point 5: ", "comes after",
       [](SavedMap& s) { changeObservation(s, [](PointObservation& o) { o.point = 6; }); }},
      {where, "pixel",
       [](SavedMap& s) { changeObservation(s, [](PointObservation& o) { o.measurement.pixel.x() = not_a_number; }); }},
      {where, "pixel",
       [](SavedMap& s) {
         changeObservation(s, [](PointObservation& o) { o.measurement.pixel.x() = -pyramid_border - 1; });
       }},
      {where, "pixel",
       [](SavedMap& s) {
         changeObservation(s, [](PointObservation& o) { o.measurement.pixel.y() = 24 + pyramid_border; });
       }},
      {where, "normal",
       [](SavedMap& s) { changeObservation(s, [](PointObservation& o) { o.measurement.normal *= 0; }); }},
      {where, "normal",
       [](SavedMap& s) { changeObservation(s, [](PointObservation& o) { o.measurement.normal.y() = not_a_number; }); }},
      {where, "deviations",
       [](SavedMap& s) { changeObservation(s, [](PointObservation& o) { o.measurement.sigma_normal = 0; }); }},
      {where, "deviations",
       [](SavedMap& s) { changeObservation(s, [](PointObservation& o) { o.measurement.sigma_tangent = -1; }); }},
      {where, "deviations",
       [](SavedMap& s) {
         changeObservation(s, [](PointObservation& o) { o.measurement.sigma_tangent = not_a_number; });
       }},
      {where, "bearing", [](SavedMap& s) { changeObservation(s, [](PointObservation& o) { o.bearing *= 2; }); }},
      {where, "bearing",
       [](SavedMap& s) { changeObservation(s, [](PointObservation& o) { o.bearing.z() = infinity; }); }},
      {where, "place on an edge", [](SavedMap& s) { changeObservation(s, [](PointObservation& o) { o.chain = -2; }); }},
      {where, "place on an edge", [](SavedMap& s) { changeObservation(s, [](PointObservation& o) { o.order = -1; }); }},
  });
}

TEST(MapCheck, Points) {
  const char* const where = "point 5: ";
  expectRefused({
      {"point 3 ", "comes after 3", [](SavedMap& s) { pointOf(s, 5).id = 3; }},
      {"point -5", "comes after 3", [](SavedMap& s) { pointOf(s, 5).id = -5; }},
      {"point -3: ", "no such number", [](SavedMap& s) { pointOf(s, 3).id = -3; }},
      {where, "bearing", [](SavedMap& s) { pointOf(s, 5).host_bearing *= 1.001; }},
      {where, "bearing", [](SavedMap& s) { pointOf(s, 5).host_bearing.x() = not_a_number; }},
      {where, "inverse depth", [](SavedMap& s) { pointOf(s, 5).inverse_depth = 0; }},
      {where, "inverse depth", [](SavedMap& s) { pointOf(s, 5).inverse_depth = -0.5; }},
      {where, "inverse depth", [](SavedMap& s) { pointOf(s, 5).inverse_depth = 1e-310; }},
      {where, "inverse depth", [](SavedMap& s) { pointOf(s, 5).inverse_depth = not_a_number; }},
      {where, "deviation", [](SavedMap& s) { pointOf(s, 5).inverse_depth_sigma = infinity; }},
      {where, "deviation", [](SavedMap& s) { pointOf(s, 5).inverse_depth_sigma = -1; }},
      {where, "place on an edge", [](SavedMap& s) { pointOf(s, 5).chain_keyframe = -1; }},
      {where, "place on an edge", [](SavedMap& s) { pointOf(s, 5).chain = -2; }},
      {where, "place on an edge", [](SavedMap& s) { pointOf(s, 5).order = -1; }},
  });
}

TEST(MapCheck, PointsAreSeenFromKeyframesThatAreThereAndSawThem) {
  const char* const where = "point 5: ";
  expectRefused({
      {where, "host is keyframe 2, which is not", [](SavedMap& s) { pointOf(s, 5).host = 2; }},
      {where, "host is keyframe -1, which is not", [](SavedMap& s) { pointOf(s, 5).host = -1; }},
      {"point 3: ", "host is keyframe 9, which has no", [](SavedMap& s) { pointOf(s, 3).host = 9; }},
      {"point 7: ", "host is keyframe 4, which has no", [](SavedMap& s) { pointOf(s, 5).id = 7; }},
      {where, "seen in keyframe 5, which is not",
       [](SavedMap& s) {
         pointOf(s, 5).seen_in = {0, 5, 9};
       }},
      {"point 3: ", "seen in keyframe 9, which has no", [](SavedMap& s) { pointOf(s, 3).seen_in = {9}; }},
      {where, "twice or out of order",
       [](SavedMap& s) {
         pointOf(s, 5).seen_in = {0, 9, 1};
       }},
      {where, "twice or out of order",
       [](SavedMap& s) {
         pointOf(s, 5).seen_in = {0, 0};
       }},
      {where, "twice or out of order",
       [](SavedMap& s) {
         pointOf(s, 5).seen_in = {0, 4};
       }},
      {where, "seen in keyframe 4, which has no",
       [](SavedMap& s) {
         pointOf(s, 5).host = 1;
         auto& seen = test::keyframeOf(s, 4).observations;
         std::vector<PointObservation> others(seen.begin(), seen.end());
         others.erase(others.begin() + 2);
         seen = others;
         pointOf(s, 5).seen_in = {0, 4};
       }},
  });
}

// In memory, where no file stands between.
TEST(MapCheck, ImagesAreGreyAndOfTheCamerasSize) {
  for (const cv::Mat& image : {cv::Mat(24, 31, CV_8U), cv::Mat(24, 32, CV_8UC3), cv::Mat()}) {
    SavedMap saved = test::madeMap(32, 24);
    auto images = std::make_shared<FrameImages>();
    images->pyramid.levels = {image};
    test::keyframeOf(saved, 4).images = images;
    EXPECT_EQ(mapProblem(saved.camera, saved.map).rfind("keyframe 4: its image", 0), 0U);
  }
  SavedMap saved = test::madeMap(32, 24);
  test::keyframeOf(saved, 4).images = std::make_shared<FrameImages>();
  EXPECT_EQ(mapProblem(saved.camera, saved.map), "keyframe 4: its images are empty");
  saved = test::madeMap(32, 24);
  pointOf(saved, 5).id = 6;
  EXPECT_EQ(mapProblem(saved.camera, saved.map), "point 5: is kept under another number");
}

TEST(MapCheck, StraightEdgesAndLinesKeepToTheRules) {
  const auto edge = [](SavedMap& saved) -> SeenEdge& { return test::keyframeOf(saved, 4).straight_edges[0]; };
  const auto line = [](SavedMap& saved) -> MapLine& { return saved.map.lines.at(3); };
  expectRefused({
      {"keyframe 4", "straight edge is not there",
       [](SavedMap& saved) { changeObservation(saved, [](PointObservation& o) { o.straight_edge = 2; }); }},
      {"keyframe 4", "straight edge is not there",
       [](SavedMap& saved) { changeObservation(saved, [](PointObservation& o) { o.straight_edge = -2; }); }},
      {"keyframe 4", "there is no such line", [&](SavedMap& saved) { edge(saved).line = -2; }},
      {"keyframe 4", "line 5 is not in the map", [&](SavedMap& saved) { edge(saved).line = 5; }},
      {"keyframe 4", "end is not in the image", [&](SavedMap& saved) { edge(saved).to.pixel.x() = not_a_number; }},
      {"keyframe 4", "no unit vector", [&](SavedMap& saved) { edge(saved).from.bearing *= 1.1; }},
      {"keyframe 4", "must be greater than 0", [&](SavedMap& saved) { edge(saved).sigma = 0; }},
      {"line 3", "no such number", [](SavedMap& saved) { saved.map.next_line = 3; }},
      {"", "the next line's number is none", [](SavedMap& saved) { saved.map.next_line = -1; }},
      {"line 3", "its place is out of range", [&](SavedMap& saved) { line(saved).in_host.point.z() = infinity; }},
      {"line 3", "no unit vector", [&](SavedMap& saved) { line(saved).in_host.direction.setZero(); }},
      {"line 3", "its extent is none", [&](SavedMap& saved) { line(saved).end = -1; }},
      {"line 3", "is its host and does not see it", [&](SavedMap& saved) { line(saved).host = 1; }},
      {"line 3", "keyframe 1, which has no view of it",
       [&](SavedMap& saved) {
         line(saved).seen_in = {0, 1, 4};
       }},
      {"line 3", "keyframe 2, which is not in the map",
       [&](SavedMap& saved) {
         line(saved).seen_in = {0, 2, 4};
       }},
      {"line 3", "twice or out of order",
       [&](SavedMap& saved) {
         line(saved).seen_in = {0, 4, 4};
       }},
      {"line 3", "which is of another world",
       [](SavedMap& saved) {
         saved.map.points.clear();
         test::keyframeOf(saved, 0).world = 1;
       }},
  });
}

TEST(MapCheck, ScalesAndGravity) {
  const auto told = [](SavedMap& saved) -> InertialAlignment& { return saved.map.inertia.at(0); };
  expectRefused({
      {"scale and gravity of world 0", "must be greater than 0",
       [&](SavedMap& saved) { told(saved).metres_a_unit = 0; }},
      {"scale and gravity of world 0", "must be greater than 0",
       [&](SavedMap& saved) { told(saved).metres_a_unit = not_a_number; }},
      {"scale and gravity of world 0", "deviation", [&](SavedMap& saved) { told(saved).scale_sigma = -0.1; }},
      {"scale and gravity of world 0", "gravity", [&](SavedMap& saved) { told(saved).gravity.setZero(); }},
      {"scale and gravity of world 0", "gravity", [&](SavedMap& saved) { told(saved).gravity.x() = not_a_number; }},
      {"scale by wheels of world 0", "must be",
       [](SavedMap& saved) { saved.map.wheels.at(0).metres_a_unit = infinity; }},
      {"scale by wheels of world 0", "deviation", [](SavedMap& saved) { saved.map.wheels.at(0).sigma = not_a_number; }},
  });
}

}  // namespace
}  // namespace edgeslam
