#include "service/map_saving.h"

#include "unit/files/temporary_folder.h"
#include "unit/service/made_service.h"

namespace edgeslam {
namespace {

using MapSavingTest = MadeService;

TEST_F(MapSavingTest, WithoutAFileItIsRefused) {
  MapSaving saving(smallCamera(), "", false, answers_, work_, log_);
  saving.begin(run_);
  saving.ask(Command());
  EXPECT_EQ(said(), "edgeslam: no file is configured for the map (map.file)\n");
}

TEST_F(MapSavingTest, AFrozenMapHasNothingNewToSave) {
  MapSaving saving(smallCamera(), "", true, answers_, work_, log_);
  saving.begin(run_);
  saving.ask(Command());
  EXPECT_EQ(said(), "edgeslam: the map is frozen (map.frozen): there is nothing new to save\n");
}

TEST_F(MapSavingTest, AnEmptyMapDoesNotTakeThePlaceOfTheOneBefore) {
  const TemporaryFolder folder;
  const std::string file = folder.write("saved.map", "the one before");
  MapSaving saving(smallCamera(), file, false, answers_, work_, log_);
  saving.begin(run_);
  saving.ask({});
  saving.mapCame(std::make_shared<const Map>());
  finishWork();
  EXPECT_EQ(said(), "edgeslam: there is no map yet\n");
  EXPECT_EQ(fileContent(file), "the one before");
}

TEST_F(MapSavingTest, AMapThatNobodyWantsSavedIsNotSaved) {
  const TemporaryFolder folder;
  MapSaving saving(smallCamera(), folder.path("saved.map"), false, answers_, work_, log_);
  saving.begin(run_);
  saving.mapCame(std::make_shared<const Map>());
  saving.end();
  finishWork();
  EXPECT_EQ(said(), "");
  EXPECT_FALSE(std::filesystem::exists(folder.path("saved.map")));
}

TEST_F(MapSavingTest, AWishThatTheRunDoesNotOutliveIsTold) {
  const TemporaryFolder folder;
  MapSaving saving(smallCamera(), folder.path("saved.map"), false, answers_, work_, log_);
  saving.begin(run_);
  saving.ask({});
  saving.end();
  saving.end();
  EXPECT_EQ(said(), "edgeslam: the run ended before the map could be saved\n");
}

}  // namespace
}  // namespace edgeslam
