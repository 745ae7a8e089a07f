// The one exception for bad input from outside: files, devices, configuration.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>

#include "edgeslam/export.h"

namespace edgeslam {

// `what()` is a message that a user can act on: file, line or key where there is one, and what was expected. The
// program prints it and exits with 2.
class EDGESLAM_PUBLIC InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message) : std::runtime_error(oneLine(message)) {}

  // As it is shown: what comes from a file must not end the line of a log, steer a terminal or fill a disk. Control
  // characters become '?', and what is beyond 8000 bytes is left out.
  static std::string oneLine(std::string message) {
    constexpr std::size_t longest = 8000;
    const auto isControl = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; };
    if (message.size() > longest) message.replace(longest, std::string::npos, " ...");
    std::replace_if(message.begin(), message.end(), isControl, '?');
    return message;
  }
};

}  // namespace edgeslam
