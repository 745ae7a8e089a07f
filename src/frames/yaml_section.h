// A map of a YAML file with keys and numbers, whose messages name file, line and key.
#pragma once

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <string>
#include <vector>

#include "edgeslam/input_error.h"
#include "files/text_file.h"

namespace edgeslam {

// All throw InputError.
class YamlSection {
 public:
  YamlSection(std::string path, const YAML::Node& node);

  bool has(const std::string& key) const;
  void rejectUnknownKeys(const std::vector<std::string>& known) const;
  YAML::Node at(const std::string& key) const;
  YamlSection section(const std::string& key) const { return YamlSection(path_, at(key)); }
  std::string text(const std::string& key) const;
  double number(const std::string& key) const { return toNumber(at(key), key); }
  int wholeNumber(const std::string& key) const { return toWholeNumber(at(key), key); }
  std::vector<double> numbers(const std::string& key) const;
  void expectSize(const std::string& key, const std::vector<double>& values,
                  const std::vector<std::size_t>& sizes) const;
  [[noreturn]] void failAt(const std::string& key, const std::string& message) const { fail(at(key), message); }

 private:
  [[noreturn]] void fail(const YAML::Node& node, const std::string& message) const;
  YAML::Node keyNode(const std::string& key) const;
  double toNumber(const YAML::Node& value, const std::string& key) const;
  int toWholeNumber(const YAML::Node& value, const std::string& key) const;

  std::string path_;
  YAML::Node node_;
  std::vector<std::string> keys_;
};

// What `read` makes of a file; `what` it is, for messages.
template <typename Function>
auto readYaml(const std::string& path, const std::string& what, const Function& read) {
  constexpr std::uintmax_t largest_file = 1 << 20;
  std::error_code error_code;
  if (!std::filesystem::is_regular_file(path, error_code)) throw InputError(path + ": no such " + what + " file");
  if (std::filesystem::file_size(path, error_code) > largest_file) {
    throw InputError(path + ": too large for a " + what);
  }
  try {
    return read(YamlSection(path, YAML::LoadFile(path)));
  } catch (const YAML::Exception& error) {
    const std::string place = error.mark.is_null() ? path + ": " : placeInFile(path, error.mark.line + 1);
    throw InputError(place + "is not valid YAML: " + error.msg);
  }
}

}  // namespace edgeslam
