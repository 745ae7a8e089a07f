#include "files/text_file.h"

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "edgeslam/input_error.h"

namespace edgeslam {
namespace {

constexpr const char* blanks = " \t\r\n\v\f";

// [ns], 126 years: the difference of two time stamps still fits into 64 bits.
constexpr std::int64_t largest_time = 4'000'000'000'000'000'000;

std::string_view trim(std::string_view text) {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

bool isDigit(char c) { return c >= '0' && c <= '9'; }

// A decimal number as digits and a power of ten: value = +-digits * 10^exponent.
struct Decimal {
  bool negative = false;
  std::string digits;
  long exponent = 0;
};

std::optional<Decimal> parseDecimal(std::string_view text) {
  Decimal decimal;
  std::size_t at = 0;
  if (at < text.size() && (text[at] == '-' || text[at] == '+')) decimal.negative = text[at++] == '-';
  while (at < text.size() && isDigit(text[at])) decimal.digits += text[at++];
  if (at < text.size() && text[at] == '.') {
    ++at;
    while (at < text.size() && isDigit(text[at])) {
      decimal.digits += text[at++];
      --decimal.exponent;
    }
  }
  if (decimal.digits.empty() || decimal.digits.size() > 100) return std::nullopt;
  if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    ++at;
    if (at < text.size() && text[at] == '+') ++at;
    int power = 0;
    const auto [end, error] = std::from_chars(text.data() + at, text.data() + text.size(), power);
    if (error != std::errc() || std::abs(power) > 100) return std::nullopt;
    decimal.exponent += power;
    at = static_cast<std::size_t>(end - text.data());
  }
  if (at != text.size()) return std::nullopt;
  return decimal;
}

// Rounds digits * 10^exponent to an integer, half away from zero.
std::optional<std::int64_t> roundToInteger(const Decimal& decimal) {
  std::string digits = decimal.digits;
  bool round_up = false;
  if (decimal.exponent >= 0) {
    digits.append(static_cast<std::size_t>(decimal.exponent), '0');
  } else {
    const std::size_t dropped = static_cast<std::size_t>(-decimal.exponent);
    if (dropped > digits.size()) return 0;
    round_up = digits[digits.size() - dropped] >= '5';
    digits.resize(digits.size() - dropped);
  }
  std::int64_t value = 0;
  for (const char c : digits) {
    const std::int64_t digit = c - '0';
    if (value > (largest_time - digit) / 10) return std::nullopt;
    value = value * 10 + digit;
  }
  if (round_up && value == largest_time) return std::nullopt;
  if (round_up) ++value;
  return decimal.negative ? -value : value;
}

}  // namespace

std::vector<TextLine> readTextLines(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(path + ": no such file");
  if (!std::filesystem::is_regular_file(status)) throw InputError(path + ": expected a text file, this is none");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path + ": cannot be opened: " + std::strerror(errno));
  std::vector<TextLine> lines;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const std::string_view text = trim(line);
    if (!text.empty() && text.front() != '#') lines.push_back({number, std::string(text), !file.eof()});
  }
  if (file.bad()) throw InputError(path + ": reading failed: " + std::strerror(errno));
  return lines;
}

std::vector<std::string_view> splitColumns(std::string_view text) {
  constexpr const char* separators = " \t\r,";
  std::vector<std::string_view> columns;
  std::size_t begin = text.find_first_not_of(separators);
  while (begin != std::string_view::npos) {
    const std::size_t end = text.find_first_of(separators, begin);
    columns.push_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(separators, end);
  }
  return columns;
}

std::optional<double> parseNumber(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<std::int64_t> parseStamp(std::string_view text) {
  std::optional<Decimal> decimal = parseDecimal(text);
  if (!decimal) return std::nullopt;
  if (text.find_first_not_of("0123456789") == std::string_view::npos) {
    const std::optional<std::int64_t> whole = roundToInteger(*decimal);
    if (whole && *whole >= 1'000'000'000'000'000) return whole;
  }
  decimal->exponent += 9;
  return roundToInteger(*decimal);
}

std::optional<std::int64_t> parseNanoseconds(std::string_view text) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if (value > largest_time || value < -largest_time) return std::nullopt;
  return value;
}

std::string formatStamp(std::int64_t time_ns) {
  const std::uint64_t size =
      time_ns < 0 ? std::uint64_t{0} - static_cast<std::uint64_t>(time_ns) : static_cast<std::uint64_t>(time_ns);
  const std::string fraction = std::to_string(size % 1'000'000'000);
  return (time_ns < 0 ? "-" : "") + std::to_string(size / 1'000'000'000) + "." + std::string(9 - fraction.size(), '0') +
         fraction;
}

std::string placeInFile(const std::string& path, int line) { return path + ":" + std::to_string(line) + ": "; }

}  // namespace edgeslam
