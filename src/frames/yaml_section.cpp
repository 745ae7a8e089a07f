#include "frames/yaml_section.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "files/key_suggestion.h"

namespace edgeslam {

YamlSection::YamlSection(std::string path, const YAML::Node& node) : path_(std::move(path)), node_(node) {
  if (!node_.IsMap()) fail(node_, "expected 'key: value' lines");
  for (const auto& entry : node_) {
    if (!entry.first.IsScalar()) fail(entry.first, "expected a plain key");
    keys_.push_back(entry.first.Scalar());
    if (std::count(keys_.begin(), keys_.end(), keys_.back()) > 1) {
      fail(entry.first, "the key '" + keys_.back() + "' is there twice");
    }
  }
}

bool YamlSection::has(const std::string& key) const {
  return std::find(keys_.begin(), keys_.end(), key) != keys_.end();
}

void YamlSection::rejectUnknownKeys(const std::vector<std::string>& known) const {
  for (const auto& entry : node_) {
    const std::string& key = entry.first.Scalar();
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    const std::string meant = closestKey(key, known);
    fail(entry.first, "unknown key '" + key + "'" + (meant.empty() ? "" : "; is '" + meant + "' meant?"));
  }
}

YAML::Node YamlSection::at(const std::string& key) const {
  if (has(key)) return node_[key];
  const std::string similar = closestKey(key, keys_);
  throw InputError(path_ + ": the key '" + key + "' is missing" +
                   (similar.empty() ? "" : "; is '" + similar + "' it, misspelt?"));
}

std::string YamlSection::text(const std::string& key) const {
  const YAML::Node value = at(key);
  if (!value.IsScalar()) fail(value, "'" + key + "' must be a word");
  return value.Scalar();
}

std::vector<double> YamlSection::numbers(const std::string& key) const {
  const YAML::Node list = at(key);
  if (!list.IsSequence()) fail(list, "'" + key + "' must be a list of numbers");
  std::vector<double> values;
  for (const YAML::Node& value : list) values.push_back(toNumber(value, key));
  return values;
}

void YamlSection::expectSize(const std::string& key, const std::vector<double>& values,
                             const std::vector<std::size_t>& sizes) const {
  if (std::find(sizes.begin(), sizes.end(), values.size()) != sizes.end()) return;
  std::string expected;
  for (const std::size_t size : sizes) expected += (expected.empty() ? "" : " or ") + std::to_string(size);
  fail(at(key), "'" + key + "' must have " + expected + " numbers, it has " + std::to_string(values.size()));
}

void YamlSection::fail(const YAML::Node& node, const std::string& message) const {
  throw InputError(placeInFile(path_, node.Mark().line + 1) + message);
}

// An absent value has the place of what follows it, so its key stands for it.
YAML::Node YamlSection::keyNode(const std::string& key) const {
  for (const auto& entry : node_) {
    if (entry.first.Scalar() == key) return entry.first;
  }
  return node_;
}

double YamlSection::toNumber(const YAML::Node& value, const std::string& key) const {
  const std::optional<double> number = value.IsScalar() ? parseNumber(value.Scalar()) : std::nullopt;
  if (!number) {
    fail(value.IsNull() ? keyNode(key) : value,
         "'" + key + "' must be a finite number" +
             (value.IsScalar() ? ", found '" + value.Scalar() + "'" : std::string()));
  }
  return *number;
}

int YamlSection::toWholeNumber(const YAML::Node& value, const std::string& key) const {
  const double number = toNumber(value, key);
  if (number != std::floor(number) || std::abs(number) > 1e9) fail(value, "'" + key + "' must be a whole number");
  return static_cast<int>(number);
}

}  // namespace edgeslam
