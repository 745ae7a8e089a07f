#include "configuration/configuration.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "configuration/configuration_text.h"
#include "unit/configuration/configuration_file.h"
#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

std::vector<std::string> problemsOf(const std::string& text) {
  const TemporaryFolder folder;
  const std::string path = folder.write("file.yaml", text);
  std::vector<std::string> problems;
  readConfiguration(path, problems);
  for (std::string& problem : problems) {
    EXPECT_EQ(problem.rfind(path, 0), 0U) << problem << " does not name the file";
    problem = problem.substr(std::min(problem.size(), path.size() - std::string("file.yaml").size()));
  }
  return problems;
}

using Lines = std::vector<std::string>;

TEST(Configuration, AnEmptyFileGivesTheDefaults) {
  const std::string defaults = formatConfiguration(Configuration{});
  for (const std::string text : {"", "\n", "# nothing\n", "---\n", "edges:\n", "edges: {}\npose:\n"}) {
    EXPECT_EQ(formatConfiguration(configurationOf(text)), defaults) << text;
  }
}

TEST(Configuration, ReadsWhatIsGivenAndLeavesTheRest) {
  const Configuration read = configurationOf("edges:\n  sigma: 2.5\npoints: {count: 300}\n");
  EXPECT_EQ(read.settings.edges.sigma, 2.5);
  EXPECT_EQ(read.settings.points.count, 300);
  EXPECT_EQ(read.settings.edges.sigma_ratio, Settings{}.edges.sigma_ratio);
  EXPECT_FALSE(read.camera);
}

TEST(Configuration, AnUnknownKeyIsToldWithTheOneThatWasMeant) {
  EXPECT_EQ(problemsOf("edges:\n  sigma: 2\n  sigam: 1\n"),
            Lines{"file.yaml:3: edges.sigam is not a key; did you mean edges.sigma?"});
  EXPECT_EQ(problemsOf("egdes:\n  sigma: 2\n"), Lines{"file.yaml:1: egdes is not a key; did you mean edges?"});
  EXPECT_EQ(problemsOf("sigma_ratio: 2\n"),
            Lines{"file.yaml:1: sigma_ratio is not a key; did you mean edges.sigma_ratio?"});
  EXPECT_EQ(problemsOf("colour: blue\n"), Lines{"file.yaml:1: colour is not a key"});
}

TEST(Configuration, AWrongValueIsToldWithWhatWasExpected) {
  EXPECT_EQ(problemsOf("edges:\n  sigma: wide\n"),
            Lines{"file.yaml:2: edges.sigma: 'wide' is not a finite number; expected 0.3 to 10 px"});
  for (const char* value : {".nan", ".inf", "-1", "1e300", "[1]", "{a: 1}", "\"2\"", "", "~", "true", "!!str 2"}) {
    const Lines problems = problemsOf(std::string("edges:\n  sigma: ") + value + "\n");
    ASSERT_EQ(problems.size(), 1U) << value;
    EXPECT_EQ(problems[0].rfind("file.yaml:2: edges.sigma: ", 0), 0U) << problems[0];
    EXPECT_NE(problems[0].find("; expected 0.3 to 10 px"), std::string::npos) << problems[0];
  }
  EXPECT_EQ(problemsOf("points:\n  count: 300.5\n"),
            Lines{"file.yaml:2: points.count: '300.5' is not a whole number; expected 50 to 5000 points"});
}

TEST(Configuration, EveryProblemIsToldInTheOrderOfTheFile) {
  const std::string text =
      "pose:\n  hubre: 1\nedges:\n  sigma: 2\n  sigma: 3\n  sigma_ratio: 0\nedges:\n  sigma: 1\nbundle: 5\n";
  EXPECT_EQ(problemsOf(text), (Lines{"file.yaml:2: pose.hubre is not a key; did you mean pose.huber?",
                                     "file.yaml:5: edges.sigma is given twice; first in line 4",
                                     "file.yaml:6: edges.sigma_ratio: 0 is out of range; expected 1.05 to 4",
                                     "file.yaml:7: edges is given twice; first in line 3",
                                     "file.yaml:9: bundle: a mapping of keys is expected"}));
  const TemporaryFolder folder;
  const std::string path = folder.write("file.yaml", text);
  try {
    readConfiguration(path);
    FAIL() << "not refused";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), path +
                                ":2: pose.hubre is not a key; did you mean pose.huber?"
                                " (the first of 5 problems; `edgeslam check-config` lists them)");
  }
}

TEST(Configuration, WhatIsNoMappingIsRefused) {
  for (const std::string text :
       {"edges\n", "- edges\n", "edges: [1, 2]\n", "edges: 1\n", "? [a]\n: 1\n", "edges:\n\tsigma: 2\n", "a: b: c\n",
        "edges: {sigma: 2\n", "--- {}\n--- {}\n", "edges: *nowhere\n", "\x01\x02\xff", "fx: 500\nwidth: 640\n"}) {
    const Lines problems = problemsOf(text);
    ASSERT_EQ(problems.size(), 1U) << text;
    EXPECT_EQ(problems[0].rfind("file.yaml:", 0), 0U) << problems[0];
    EXPECT_EQ(problems[0].find('\n'), std::string::npos) << problems[0];
  }
}

TEST(Configuration, HostileTextIsRefusedWithoutHarm) {
  EXPECT_FALSE(problemsOf(std::string(100000, '[')).empty());
  EXPECT_FALSE(problemsOf(std::string(100000, '{')).empty());
  EXPECT_FALSE(problemsOf(std::string(1000, '\0')).empty());
  EXPECT_FALSE(problemsOf("edges: &e\n  edges: *e\n").empty());
  EXPECT_FALSE(problemsOf("edges:\n  ? *a\n  : &a 1\n").empty());
  EXPECT_EQ(problemsOf(", 0.5]\npoints: {count: 300}\n"), Lines{"file.yaml:1: is not YAML: a key is expected here"});
  EXPECT_EQ(problemsOf("points: {count: 300}\n---\n, 1\n"),
            Lines{"file.yaml:2: a second document; only one is expected"});
  EXPECT_EQ(problemsOf(std::string((1 << 20) + 1, '\n')), Lines{"file.yaml: over 1 MiB, so it is no configuration"});
}

TEST(Configuration, EveryTruncationOfTheDefaultsIsReadOrRefused) {
  const std::string whole = usersConfigurationText();
  const TemporaryFolder folder;
  int refused = 0;
  for (std::size_t length = 0; length < whole.size(); length += 29) {
    std::vector<std::string> problems;
    readConfiguration(folder.write("file.yaml", whole.substr(0, length)), problems);
    refused += problems.empty() ? 0 : 1;
  }
  EXPECT_GT(refused, 0);
}

TEST(Configuration, WhatItSaysItselfCountsOverWhatItIncludes) {
  const TemporaryFolder folder;
  folder.write("base.yaml", "points: {count: 300, spacing: 9}\ncamera: {calibration: camera.yaml}\n");
  folder.write("camera.yaml", "width: 640\nheight: 480\nfx: 500\nfy: 500\ncx: 320\ncy: 240\n");
  std::filesystem::create_directory(folder.path("robots"));
  for (const char* text :
       {"include: ../base.yaml\npoints: {count: 400}\n", "points: {count: 400}\ninclude: ../base.yaml\n"}) {
    const Configuration read = readConfiguration(folder.write("robots/robot.yaml", text));
    EXPECT_EQ(read.settings.points.count, 400) << text;
    EXPECT_EQ(read.settings.points.spacing, 9);
    ASSERT_TRUE(read.camera) << "named relative to the file that names it";
    EXPECT_EQ(read.camera->fx, 500);
    EXPECT_EQ(read.source, folder.path("robots/robot.yaml"));
  }
}

TEST(Configuration, ProblemsOfAnIncludedFileAreToldWithItsName) {
  const TemporaryFolder folder;
  const std::string base = folder.write("base.yaml", "include: base.yaml\npoints:\n  cuont: 300\n");
  const std::string robot = folder.write("robot.yaml", "include: base.yaml\npoints: {count: -1}\n");
  std::vector<std::string> problems;
  readConfiguration(robot, problems);
  ASSERT_EQ(problems.size(), 3U);
  EXPECT_EQ(problems[0], base + ":1: include: an included file includes no other");
  EXPECT_EQ(problems[1], base + ":3: points.cuont is not a key; did you mean points.count?");
  EXPECT_EQ(problems[2].rfind(robot + ":2: points.count", 0), 0U) << problems[2];

  problems.clear();
  readConfiguration(folder.write("lost.yaml", "include: nowhere.yaml\n"), problems);
  EXPECT_EQ(problems, Lines{folder.path("nowhere.yaml") + ": cannot be opened"});
  ASSERT_EQ(::mkfifo(folder.path("pipe.yaml").c_str(), 0600), 0);
  problems.clear();
  readConfiguration(folder.write("pipes.yaml", "include: pipe.yaml\n"), problems);
  EXPECT_EQ(problems, Lines{folder.path("pipes.yaml") + ":1: include: pipe.yaml is no file"});
  EXPECT_EQ(problemsOf("points: {}\ninclude: [a, b]\n"), Lines{"file.yaml:2: include: the path of a file is expected"});
}

TEST(Configuration, AMissingFileAndAFolderAreRefused) {
  EXPECT_THROW(readConfiguration("/no/such/file.yaml"), InputError);
  EXPECT_THROW(readConfiguration("/"), InputError);
}

TEST(Configuration, TheEffectiveConfigurationReadsBackAsTheSame) {
  const Configuration configuration = configurationOf(
      "camera: {model: kannala_brandt, width: 640, height: 480, fx: 300.1, fy: 300.2, cx: 320, cy: 240, k1: 0.1, k4: "
      "0.004,\n"
      "  body_T_camera: {translation: [0.1, 0.2, 0.3], quaternion: [0.5, -0.5, 0.5, -0.5]}}\n"
      "edges: {sigma: 1.123456789012345}\nbundle: {iterations: 3}\n");
  const std::string text = formatConfiguration(configuration);
  EXPECT_EQ(formatConfiguration(configurationOf(text)), text);
  EXPECT_NE(text, formatConfiguration(Configuration{}));
}

TEST(Configuration, TheDocumentedFilesGiveTheDefaults) {
  const std::string defaults = formatConfiguration(Configuration{});
  EXPECT_EQ(formatConfiguration(configurationOf(usersConfigurationText())), defaults);
  EXPECT_EQ(formatConfiguration(configurationOf(expertConfigurationText())), defaults);
}

std::string committed(const std::string& name) {
  std::ifstream file(EDGESLAM_SOURCE_DIR "/firmware_cfg/" + name);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(Configuration, TheCommittedFilesAreWhatTheTableGenerates) {
  EXPECT_EQ(committed("edgeslam.yaml"), usersConfigurationText())
      << "write it anew: edgeslam check-config --print-default > firmware_cfg/edgeslam.yaml";
  EXPECT_EQ(committed("expert.yaml"), expertConfigurationText())
      << "write it anew: edgeslam check-config --print-expert > firmware_cfg/expert.yaml";
}

}  // namespace
}  // namespace edgeslam
