#include "plugins/plugin.h"

#include <gtest/gtest.h>

#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

TEST(Plugin, WhatIsNotThereIsNamed) {
  const OpenedPlugin opened = openPlugin("libedgeslam_nothing.so", "open", {"/nowhere", "/neither"});
  EXPECT_EQ(opened.function, nullptr);
  EXPECT_EQ(opened.problem, "libedgeslam_nothing.so is not there");
}

TEST(Plugin, AFileThatIsNoLibraryIsRefused) {
  const TemporaryFolder folder;
  const std::string path = folder.write("libedgeslam_text.so", "no library");
  const OpenedPlugin opened = openPlugin("libedgeslam_text.so", "open", {"/nowhere", folder.path("")});
  EXPECT_EQ(opened.function, nullptr);
  EXPECT_NE(opened.problem.find(path), std::string::npos) << opened.problem;
}

TEST(Plugin, IsLookedForBesideTheProgramAndWhereItIsInstalled) {
  const std::vector<std::string> folders = pluginFolders();
  ASSERT_EQ(folders.size(), 2U);
  EXPECT_EQ(folders[0].front(), '/');
  EXPECT_NE(folders[1].find("/edgeslam"), std::string::npos);
}

}  // namespace
}  // namespace edgeslam
