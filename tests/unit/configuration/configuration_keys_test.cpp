// The table of keys: every key is well formed, sets a field of its own, and what a file says of it arrives there alone.
#include "configuration/configuration_keys.h"

#include <gtest/gtest.h>

#include <set>

#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

TEST(ConfigurationKeys, EachStandsInItsSectionOnce) {
  Configuration configuration;
  std::set<std::string> paths;
  std::string section;
  for (const ConfigurationKey& key : configurationKeys(configuration)) {
    EXPECT_TRUE(paths.insert(key.path).second) << key.path << " is there twice";
    if (key.isHeading()) {
      EXPECT_FALSE(key.documentation.empty()) << key.path;
      EXPECT_FALSE(key.hasField()) << key.path;
      section = key.path;
    } else {
      EXPECT_EQ(key.section(), section) << key.path << " stands outside its section";
      EXPECT_EQ(key.name().find('.'), std::string::npos) << key.path;
      EXPECT_TRUE(key.hasField() || key.for_users) << key.path << " cannot be written by expert.yaml";
    }
  }
}

TEST(ConfigurationKeys, EachHasAFieldOfItsOwn) {
  Configuration configuration;
  std::set<const void*> fields;
  for (const ConfigurationKey& key : configurationKeys(configuration)) {
    const void* field = nullptr;
    if (const auto* number = std::get_if<double*>(&key.field)) field = *number;
    if (const auto* count = std::get_if<int*>(&key.field)) field = *count;
    if (const auto* flag = std::get_if<bool*>(&key.field)) field = *flag;
    if (const auto* text = std::get_if<std::string*>(&key.field)) field = *text;
    if (!field) continue;
    EXPECT_TRUE(fields.insert(field).second) << key.path << " sets a field that another key sets";
  }
}

TEST(ConfigurationKeys, DefaultsAreInRangeAndReadBackAsTheyAre) {
  Configuration configuration;
  for (const ConfigurationKey& key : configurationKeys(configuration)) {
    if (!key.hasField() || !key.example.empty()) continue;
    const std::string text = valueText(key.field);
    EXPECT_EQ(setValue(key, text), "") << key.path;
    EXPECT_EQ(valueText(key.field), text) << key.path;
  }
}

// Another value than the default, that is allowed.
std::string otherValue(const ConfigurationKey& key) {
  if (const auto* flag = std::get_if<bool*>(&key.field)) return **flag ? "false" : "true";
  if (std::holds_alternative<std::string*>(key.field)) {
    if (key.path == "scale.source") return "camera_height";
    if (key.path == "viewer.address") return "127.0.0.2";
    if (key.path == "ros2.transforms") return "map_to_odom";
    return key.example.empty() ? "ANOTHER_NAME" : key.example;
  }
  const bool is_least = valueText(key.field) == numberText(key.least);
  return numberText(is_least ? key.least + (key.largest - key.least > key.step ? key.step : key.largest - key.least)
                             : key.least);
}

// Some values are only possible beside others.
std::string beside(const std::string& path) {
  if (path == "capture.width") return "  height: 480\n";
  if (path == "capture.height") return "  width: 640\n";
  if (path == "scale.source") return "  camera_height_m: 1\n";
  return "";
}

TEST(ConfigurationKeys, WhatAFileSaysOfAKeyArrivesAndChangesNoOther) {
  const TemporaryFolder folder;
  Configuration usual;
  const std::vector<ConfigurationKey> keys = configurationKeys(usual);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (!keys[i].hasField()) continue;
    const std::string value = otherValue(keys[i]), extra = beside(keys[i].path);
    const std::string text = keys[i].section() + ":\n  " + keys[i].name() + ": " + value + "\n" + extra;
    Configuration read = readConfiguration(folder.write("file.yaml", text));
    const std::vector<ConfigurationKey> read_keys = configurationKeys(read);
    int changed = 0;
    for (std::size_t k = 0; k < keys.size(); ++k) changed += valueText(read_keys[k].field) != valueText(keys[k].field);
    EXPECT_NE(valueText(read_keys[i].field), valueText(keys[i].field)) << text;
    EXPECT_EQ(changed, extra.empty() ? 1 : 2) << text;
  }
}

}  // namespace
}  // namespace edgeslam
