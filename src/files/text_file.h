// Text files of numbers, as data sets come in: lines with '#' comments, columns parted by blanks or commas, time
// stamps.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace edgeslam {

struct TextLine {
  int number = 0;     // in the file, counted from 1
  std::string text;   // without line end and surrounding blanks
  bool ended = true;  // false: the file's last line has no line end; it may have been torn by a power cut
};

// The lines of a file that are neither empty nor comments ('#' first). Throws InputError with path and reason where it
// cannot be read or is not a regular file.
std::vector<TextLine> readTextLines(const std::string& path);

// Columns parted by blanks, tabs or commas; none is empty.
std::vector<std::string_view> splitColumns(std::string_view text);

// A finite number that takes up the whole text, whatever the locale; nothing otherwise.
std::optional<double> parseNumber(std::string_view text);

// Nanoseconds of a time stamp: decimal seconds ("1305031102.175304", "1.3e9", read exactly and rounded to the
// nanosecond), or whole nanoseconds where it is an integer of 1e15 or more (EuRoC). Nothing where it is no such number
// or out of range.
std::optional<std::int64_t> parseStamp(std::string_view text);

// Whole nanoseconds; nothing where it is no integer or beyond 4e18.
std::optional<std::int64_t> parseNanoseconds(std::string_view text);

// Seconds with 9 decimals.
std::string formatStamp(std::int64_t time_ns);

// "FILE:LINE: ", how messages about a line of a file begin.
std::string placeInFile(const std::string& path, int line);

}  // namespace edgeslam
