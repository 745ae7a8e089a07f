#include "app/map_info.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "unit/map/made_map.h"

namespace edgeslam::test {
namespace {

TEST(MapInfo, TellsTheSameToPeopleAndPrograms) {
  const SavedMap saved = madeMap(64, 48);
  const std::string text = mapInfoText("a.map", 1'500'000, saved);
  for (const char* part : {"a.map: format version 4, 1.50 MB", "kannala_brandt, 64 x 48 pixels", "readout 0.0333333 s",
                           "map 0: 4 keyframes (0 to 9), 2 of them with images, 3 points, 1 lines",
                           "a map unit is 0.3333 m +- 3.3 %, by inertia; down is 0.098 0.976 -0.195", "map units"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  }
  const nlohmann::json json = mapInfoJson("a.map", 1'500'000, saved);
  EXPECT_EQ(json["format_version"], 4);
  EXPECT_EQ(json["camera"]["width"], 64);
  ASSERT_EQ(json["worlds"].size(), 1U);
  EXPECT_EQ(json["worlds"][0]["keyframes"], 4);
  EXPECT_EQ(json["worlds"][0]["points"], 3);
  EXPECT_NEAR(json["worlds"][0]["cameras"]["most"][0].get<double>(), 0.9, 1e-12);
  EXPECT_EQ(json["worlds"][0]["scale"]["metres_per_unit"], 1.0 / 3);
  EXPECT_EQ(json["worlds"][0]["scale"]["source"], "inertia");
}

TEST(MapInfo, TellsTheScaleOfWheelsOrOfNothing) {
  SavedMap saved = madeMap(64, 48);
  saved.map.inertia.clear();
  EXPECT_NE(mapInfoText("a.map", 1, saved).find("a map unit is 0.1429 m +- 0.3 %, by wheels\n"), std::string::npos);
  EXPECT_FALSE(mapInfoJson("a.map", 1, saved)["worlds"][0]["scale"].contains("down"));
  saved.map.wheels.clear();
  EXPECT_NE(mapInfoText("a.map", 1, saved).find("how long a map unit is is not known"), std::string::npos);
  EXPECT_TRUE(mapInfoJson("a.map", 1, saved)["worlds"][0]["scale"].is_null());
}

TEST(CalibrationDifference, NamesWhatDiffers) {
  const Camera camera = madeMap(64, 48).camera;
  EXPECT_EQ(calibrationDifference(camera, camera), "");
  Camera other = camera;
  other.fy = 50;
  EXPECT_EQ(calibrationDifference(camera, other), "its fy is 44.8, the other's is 50");
  other = camera;
  other.readout_s = 0;
  EXPECT_NE(calibrationDifference(camera, other).find("readout"), std::string::npos);
  other = camera;
  other.model = CameraModel::pinhole_radial_tangential;
  EXPECT_NE(calibrationDifference(camera, other).find("pinhole"), std::string::npos);
  // Whatever makes two calibrations differ is named.
  for (std::size_t i = 0; i < camera.distortion.size(); ++i) {
    other = camera;
    other.distortion[i] += 0.125;
    EXPECT_FALSE(other == camera);
    EXPECT_NE(calibrationDifference(camera, other), "") << i;
  }
}

}  // namespace
}  // namespace edgeslam::test
