// A key of the configuration and its value: what is allowed, how it is read and written.
#pragma once

#include <string>
#include <variant>

namespace edgeslam {

// What a key sets; monostate where it is a section's heading, or has a reader of its own.
using ConfigurationField = std::variant<std::monostate, double*, int*, bool*, std::string*>;

struct ConfigurationKey {
  std::string path;  // "edges.sigma"; "edges" for a heading
  ConfigurationField field;
  std::string unit{};           // empty where it is a plain number
  double least = 0;             // both bounds are allowed values; without meaning where it is no number
  double largest = 0;           // likewise
  std::string documentation{};  // a line or more
  int step = 1;                 // of a whole number: least, least + step, ...
  std::string example{};        // of a value; where it is given, the default is not one that can be written
  bool for_users = false;       // in edgeslam.yaml; the others are in expert.yaml

  bool isHeading() const { return path.find('.') == std::string::npos; }
  bool hasField() const { return !std::holds_alternative<std::monostate>(field); }
  std::string section() const { return path.substr(0, path.find('.')); }
  std::string name() const { return path.substr(path.find('.') + 1); }
};

// "0.3 to 10 px", "true or false", "3 to 63 px in steps of 2", "a text".
std::string expectedValue(const ConfigurationKey& key);

// The field's value as YAML; a number in the fewest digits that read back as the same one.
std::string valueText(const ConfigurationField& field);
std::string numberText(double value);

// Reads `text` into the field. Returns what is wrong with it ("'abc' is not a number"), or an empty string.
std::string setValue(const ConfigurationKey& key, const std::string& text);

// A finite number that fills the whole text; false otherwise, leaving `value` as it was.
bool parseNumber(const std::string& text, double& value);

// As YAML, also inside of "{...}", where a comma or bracket would end a word.
std::string inQuotes(const std::string& text);

}  // namespace edgeslam
