#include "configuration/configuration_value.h"

#include <yaml-cpp/yaml.h>

#include <charconv>
#include <cmath>

namespace edgeslam {
namespace {

constexpr std::size_t longest_text = 1000;

}  // namespace

std::string numberText(double value) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof(digits), value).ptr;
  return std::string(digits, end);
}

std::string valueText(const ConfigurationField& field) {
  if (const auto* number = std::get_if<double*>(&field)) return numberText(**number);
  if (const auto* count = std::get_if<int*>(&field)) return std::to_string(**count);
  if (const auto* flag = std::get_if<bool*>(&field)) return **flag ? "true" : "false";
  if (const auto* text = std::get_if<std::string*>(&field)) return inQuotes(**text);
  return "";
}

std::string expectedValue(const ConfigurationKey& key) {
  if (std::holds_alternative<bool*>(key.field)) return "true or false";
  if (std::holds_alternative<std::string*>(key.field)) return "a text";
  return numberText(key.least) + " to " + numberText(key.largest) + (key.unit.empty() ? "" : " " + key.unit) +
         (key.step > 1 ? " in steps of " + std::to_string(key.step) : "");
}

bool parseNumber(const std::string& text, double& value) {
  const char* begin = text.data() + (text.size() > 1 && text[0] == '+' && text[1] != '-' ? 1 : 0);
  const char* end = text.data() + text.size();
  double number = 0;
  const auto [stop, error] = std::from_chars(begin, end, number);
  if (error != std::errc() || stop != end || !std::isfinite(number)) return false;
  value = number;
  return true;
}

std::string setValue(const ConfigurationKey& key, const std::string& text) {
  if (const auto* flag = std::get_if<bool*>(&key.field)) {
    if (text != "true" && text != "false") return "'" + text + "' is neither true nor false";
    **flag = text == "true";
    return "";
  }
  if (const auto* field = std::get_if<std::string*>(&key.field)) {
    if (text.empty() || text.size() > longest_text) return "a text of 1 to 1000 letters is expected";
    **field = text;
    return "";
  }
  double value = 0;
  if (!parseNumber(text, value)) return "'" + text + "' is not a finite number";
  const auto* count = std::get_if<int*>(&key.field);
  if (count && value != std::floor(value)) return "'" + text + "' is not a whole number";
  if (value < key.least || value > key.largest) return text + " is out of range";
  if (count && std::fmod(value - key.least, key.step) != 0) return text + " is between the steps";
  if (count) {
    **count = static_cast<int>(value);
  } else if (const auto* number = std::get_if<double*>(&key.field)) {
    **number = value;
  }
  return "";
}

std::string inQuotes(const std::string& text) {
  YAML::Emitter emitter;
  if (text.find_first_of(",[]{}") != std::string::npos) emitter << YAML::DoubleQuoted;
  emitter << text;
  return emitter.c_str();
}

}  // namespace edgeslam
