#include "benchmark/json_reader.h"

#include <cmath>
#include <filesystem>
#include <fstream>

namespace edgeslam {
namespace {

using nlohmann::ordered_json;

constexpr double largest_number = 1e15;

// What stands there, short enough for a message.
std::string shown(const ordered_json& value) {
  std::string text = value.dump(-1, ' ', true, ordered_json::error_handler_t::replace);
  if (text.size() > 40) text = text.substr(0, 40) + "...";
  return text;
}

}  // namespace

std::string readBoundedFile(const std::string& path, std::size_t largest) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(path + ": no such file");
  if (!std::filesystem::is_regular_file(status)) throw InputError(path + ": is not a regular file");
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error || size > largest) {
    throw InputError(path + ": expected at most " + std::to_string(largest >> 20U) + " MiB");
  }
  std::ifstream file(path, std::ios::binary);
  std::string text(size, '\0');
  file.read(text.data(), static_cast<std::streamsize>(size));
  if (!file || file.gcount() != static_cast<std::streamsize>(size)) throw InputError(path + ": cannot be read");
  return text;
}

ordered_json readJsonObject(const std::string& path, std::size_t largest) {
  const std::string text = readBoundedFile(path, largest);
  ordered_json json;
  try {
    json = ordered_json::parse(text);
  } catch (const ordered_json::exception& problem) {
    const std::string what = problem.what();  // "[json.exception...] parse error at line 3, column 5: ..."
    const std::size_t begin = what.find("] ");
    throw InputError(path + ": expected JSON: " + (begin == std::string::npos ? what : what.substr(begin + 2, 200)));
  }
  if (!json.is_object()) throw InputError(path + ": expected a JSON object, found " + shown(json));
  return json;
}

void JsonReader::fail(const std::string& key, const std::string& expected) const {
  const bool there = object_.is_object() && object_.contains(key);
  throw InputError(path_ + ": " + keys_ + key + ": expected " + expected +
                   (there ? ", found " + shown(object_[key]) : ", but it is missing (a file of another version?)"));
}

const ordered_json& JsonReader::at(const std::string& key, const std::string& expected) const {
  if (!object_.is_object() || !object_.contains(key)) fail(key, expected);
  return object_[key];
}

JsonReader JsonReader::object(const std::string& key) const {
  const ordered_json& value = at(key, "an object");
  if (!value.is_object()) fail(key, "an object");
  return {path_, value, keys_ + key + "."};
}

const ordered_json& JsonReader::array(const std::string& key) const {
  const ordered_json& value = at(key, "an array");
  if (!value.is_array() || value.size() > 100000) fail(key, "an array of at most 100000 elements");
  return value;
}

JsonReader JsonReader::element(const std::string& key, std::size_t index) const {
  const ordered_json& value = array(key).at(index);
  const std::string place = keys_ + key + "[" + std::to_string(index) + "]";
  if (!value.is_object()) throw InputError(path_ + ": " + place + ": expected an object, found " + shown(value));
  return {path_, value, place + "."};
}

std::string JsonReader::text(const std::string& key) const {
  const ordered_json& value = at(key, "a text");
  if (!value.is_string()) fail(key, "a text");
  return value.get<std::string>();
}

std::int64_t JsonReader::count(const std::string& key) const {
  const ordered_json& value = at(key, "a whole number of 0 or more");
  if (!value.is_number_integer() || value.get<double>() < 0 || value.get<double>() > largest_number) {
    fail(key, "a whole number of 0 to 1e15");
  }
  return value.get<std::int64_t>();
}

double JsonReader::number(const std::string& key) const {
  const ordered_json& value = at(key, "a number of 0 or more");
  if (!value.is_number()) fail(key, "a number of 0 to 1e15");
  const auto number = value.get<double>();
  if (!(number >= 0 && number <= largest_number)) fail(key, "a number of 0 to 1e15");
  return number;
}

std::optional<double> JsonReader::numberOrNull(const std::string& key) const {
  return isNull(key) ? std::nullopt : std::optional<double>(number(key));
}

bool JsonReader::isNull(const std::string& key) const { return at(key, "a value or null").is_null(); }

}  // namespace edgeslam
