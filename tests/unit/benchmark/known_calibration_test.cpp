#include "benchmark/known_calibration.h"

#include <gtest/gtest.h>

#include "frames/calibration_file.h"

namespace edgeslam {
namespace {

Camera shipped(const std::string& name) {
  return readCalibration(std::string(EDGESLAM_SOURCE_DIR) + "/firmware_cfg/cameras/" + name + ".yaml");
}

TEST(KnownCalibration, isWhatTheShippedFilesSay) {
  EXPECT_EQ(knownCalibration("fr1_xyz"), shipped("tum_fr1"));
  EXPECT_EQ(knownCalibration("fr2_desk"), shipped("tum_fr2"));
  EXPECT_EQ(knownCalibration("fr3_structure_texture_far"), shipped("tum_fr3"));
  EXPECT_EQ(knownCalibration("office0"), shipped("icl_nuim"));
}

TEST(KnownCalibration, isFoundByEveryNameOfASequence) {
  for (const char* name : {"/data/tum/rgbd_dataset_freiburg1_desk2/", "freiburg1_room", "fr1_plant", "FR1_360"}) {
    EXPECT_EQ(knownCalibration(name), shipped("tum_fr1")) << name;
  }
  for (const char* name : {"rgbd_dataset_freiburg3_long_office_household", "fr3_sitting_static"}) {
    EXPECT_EQ(knownCalibration(name), shipped("tum_fr3")) << name;
  }
  for (const char* name :
       {"office_traj2_frei_png", "of_kt1", "living_room_traj0_frei_png", "living_room_traj3n_frei_png", "lr_kt2",
        "icl_nuim_living_room_traj1_frei_png", "/x/traj/office3"}) {
    EXPECT_EQ(knownCalibration(name), shipped("icl_nuim")) << name;
  }
}

TEST(KnownCalibration, othersHaveNone) {
  for (const char* name : {"", "/", "xyz", "fr4_desk", "my_fr1_desk", "MH_01_easy", "office_lowtex", "office4",
                           "living_room", "freiburg"}) {
    EXPECT_FALSE(knownCalibration(name)) << name;
  }
  EXPECT_FALSE(knownCalibration(std::string(100000, 'l')));
}

}  // namespace
}  // namespace edgeslam
