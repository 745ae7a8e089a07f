// Commands from the page: the same as over LCM, by the same checks.
#include "drivers/viewer/command_request.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace edgeslam {
namespace {

TEST(CommandRequest, EveryCommandIsRead) {
  const std::pair<const char*, CommandKind> kinds[] = {{"reset", CommandKind::reset},
                                                       {"save_map", CommandKind::save_map},
                                                       {"start_recording", CommandKind::start_recording},
                                                       {"stop_recording", CommandKind::stop_recording},
                                                       {"send_map", CommandKind::send_map}};
  for (const auto& [name, kind] : kinds) {
    const CommandRequest request = readCommandRequest(std::string(R"({"command": ")") + name + "\"}", 7);
    ASSERT_TRUE(request.command) << request.problem;
    EXPECT_EQ(request.command->kind, kind) << name;
    EXPECT_EQ(request.command->id, 7);
    EXPECT_EQ(request.command->sender, CommandSender::viewer);
  }
  const CommandRequest scale = readCommandRequest(
      R"({"command": "set_scale", "from_utime": 1, "to_utime": 9007199254740993, "distance_m": 0.5})", 8);
  ASSERT_TRUE(scale.command) << scale.problem;
  EXPECT_EQ(scale.command->kind, CommandKind::set_scale);
  EXPECT_EQ(scale.command->from_utime, 1);
  EXPECT_EQ(scale.command->to_utime, 9007199254740993);
  EXPECT_EQ(scale.command->distance_m, 0.5);
}

TEST(CommandRequest, AReasonIsOneLine) {
  for (const char* body : {R"({"command": "reset", "a\nb": 1})", R"({"command": "set_scale", "\u001b[31m\r": 1})"}) {
    const std::string problem = readCommandRequest(body, 1).problem;
    EXPECT_NE(problem.find("is not expected"), std::string::npos) << problem;
    for (const unsigned char c : problem) EXPECT_GE(c, 32) << problem;
  }
}

TEST(CommandRequest, WhatMakesNoSenseIsRefusedInWords) {
  const std::pair<std::string, const char*> cases[] = {
      {"", "JSON object"},
      {"{", "JSON object"},
      {"[]", "JSON object"},
      {"\"reset\"", "JSON object"},
      {"null", "JSON object"},
      {"{\"command\": \"reset\"} {}", "JSON object"},
      {"{\"command\": \"\xff\"}", "JSON object"},
      {std::string(4096, '['), "JSON object"},
      {std::string(2000, '[') + std::string(2000, ']'), "JSON object"},
      {"{}", "command must be"},
      {R"({"command": "shutdown"})", "command must be"},
      {R"({"command": 0})", "command must be"},
      {R"({"command": ["reset"]})", "command must be"},
      {R"({"command": "reset", "file": "/etc/passwd"})", "'file' is not expected"},
      {R"({"command": "set_scale", "file": 1})", "'file' is not expected"},
      {R"({"command": "set_scale"})", "distance_m must be over 0"},
      {R"({"command": "set_scale", "from_utime": 1, "to_utime": 2, "distance_m": NaN})", "JSON object"},
      {R"({"command": "set_scale", "from_utime": 1, "to_utime": 2, "distance_m": 1e999})", "JSON object"},
      {R"({"command": "set_scale", "from_utime": 1, "to_utime": 2, "distance_m": "1"})", "distance_m must be a number"},
      {R"({"command": "set_scale", "from_utime": 1, "to_utime": 2, "distance_m": null})",
       "distance_m must be a number"},
      {R"({"command": "set_scale", "from_utime": 1, "to_utime": 2, "distance_m": -1})", "distance_m must be over 0"},
      {R"({"command": "set_scale", "from_utime": 2, "to_utime": 2, "distance_m": 1})", "from_utime must be before"},
      {R"({"command": "set_scale", "from_utime": 1.5, "to_utime": 2, "distance_m": 1})", "from_utime must be a whole"},
      {R"({"command": "set_scale", "from_utime": 1, "to_utime": 18446744073709551615, "distance_m": 1})",
       "to_utime must be a whole"},
  };
  for (const auto& [body, part] : cases) {
    const CommandRequest request = readCommandRequest(body, 1);
    EXPECT_FALSE(request.command) << body.substr(0, 100);
    EXPECT_NE(request.problem.find(part), std::string::npos) << body.substr(0, 100) << ": " << request.problem;
  }
}

TEST(CommandRequest, AnswersAreJsonWhateverTheMessageHolds) {
  for (const std::string& message : {std::string("saved to \"a\\b\"\n"), std::string("\xff\xfe"), std::string()}) {
    const nlohmann::json answer = nlohmann::json::parse(commandAnswerText(true, message));
    EXPECT_TRUE(answer["accepted"].get<bool>());
    EXPECT_TRUE(answer["message"].is_string());
  }
}

}  // namespace
}  // namespace edgeslam
