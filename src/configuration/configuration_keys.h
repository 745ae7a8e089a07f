// The one table of everything that can be configured. Reading, checking, the documentation in
// firmware_cfg/edgeslam.yaml and the listing of an effective configuration all follow from it: a new key is one line in
// configuration_keys.cpp.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "pipeline/settings.h"

namespace edgeslam {

// A field of Settings that a key sets; monostate for a section's heading.
using ConfigurationField = std::variant<std::monostate, double*, int*, bool*>;

struct ConfigurationKey {
  std::string path;  // "edges.sigma"; "edges" for a heading
  ConfigurationField field;
  std::string unit;  // empty where it is a plain number
  double least = 0;  // both bounds are allowed values; without meaning for a bool
  double largest = 0;
  std::string documentation;
  int step = 1;  // of a whole number: least, least + step, ...

  bool isHeading() const { return std::holds_alternative<std::monostate>(field); }
};

// The keys in the order of the file, each pointing into `settings`, which must outlive them.
std::vector<ConfigurationKey> configurationKeys(Settings& settings);

// "0.3 to 10 px", "true or false", "3 to 63 px in steps of 2".
std::string expectedValue(const ConfigurationKey& key);

// The field's value as YAML, in the fewest digits that read back as the same number.
std::string valueText(const ConfigurationField& field);
std::string numberText(double value);

// Reads `text` into the field. Returns what is wrong with it ("'abc' is not a number"), or an empty string.
std::string setValue(const ConfigurationKey& key, const std::string& text);

// A finite number that fills the whole text; false otherwise, leaving `value` as it was.
bool parseNumber(const std::string& text, double& value);

}  // namespace edgeslam
