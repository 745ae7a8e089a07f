#include "service/recording_folder.h"

#include <gtest/gtest.h>

#include <regex>

#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

TEST(RecordingFolder, IsNamedByTheTimeAndNeverOneThatIsThere) {
  const TemporaryFolder parent;
  const std::string recordings = parent.path("recordings");
  std::vector<std::string> folders;
  for (int i = 0; i < 3; ++i) {
    folders.push_back(nextRecordingFolder(recordings));
    EXPECT_FALSE(std::filesystem::exists(folders.back()));
    EXPECT_TRUE(std::regex_match(folders.back(), std::regex(".*/recordings/\\d{8}T\\d{6}Z(-[23])?"))) << folders.back();
    std::filesystem::create_directory(folders.back());
  }
}

TEST(RecordingFolder, NoneIsConfigured) {
  expectInputError([] { nextRecordingFolder(""); }, "recording.folder");
}

}  // namespace
}  // namespace edgeslam
