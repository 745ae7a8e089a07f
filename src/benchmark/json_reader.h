// Values from a JSON file of somebody else's: each is checked, and what is wrong is told with file and key.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "edgeslam/input_error.h"

namespace edgeslam {

// The text of a regular file of at most `largest` bytes. Throws InputError.
std::string readBoundedFile(const std::string& path, std::size_t largest);

// The JSON object in a file. Throws InputError with path, line and column where there is none.
nlohmann::ordered_json readJsonObject(const std::string& path, std::size_t largest = std::size_t{64} << 20U);

// An object of the file, and the names of the keys that lead to it. All functions throw InputError
// "FILE: KEY.KEY: expected ..., found ...".
class JsonReader {
 public:
  JsonReader(std::string path, const nlohmann::ordered_json& object) : path_(std::move(path)), object_(object) {}

  JsonReader object(const std::string& key) const;
  const nlohmann::ordered_json& array(const std::string& key) const;
  std::string text(const std::string& key) const;
  std::int64_t count(const std::string& key) const;                  // whole, 0 to 1e15
  double number(const std::string& key) const;                       // finite, 0 to 1e15
  std::optional<double> numberOrNull(const std::string& key) const;  // likewise
  bool isNull(const std::string& key) const;                         // there, but null
  bool has(const std::string& key) const { return object_.contains(key); }
  // An element of an array of objects.
  JsonReader element(const std::string& key, std::size_t index) const;
  const nlohmann::ordered_json& json() const { return object_; }

  [[noreturn]] void fail(const std::string& key, const std::string& expected) const;

 private:
  JsonReader(std::string path, const nlohmann::ordered_json& object, std::string keys)
      : path_(std::move(path)), object_(object), keys_(std::move(keys)) {}
  const nlohmann::ordered_json& at(const std::string& key, const std::string& expected) const;

  std::string path_;
  const nlohmann::ordered_json& object_;
  std::string keys_;  // "stage_times_ms."
};

}  // namespace edgeslam
