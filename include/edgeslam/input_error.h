// The one exception for bad input from outside: files, devices, configuration.
#pragma once

#include <stdexcept>
#include <string>

#include "edgeslam/export.h"

namespace edgeslam {

// `what()` is a message that a user can act on: file, line or key where there is one, and what was expected. The
// program prints it and exits with 2.
class EDGESLAM_PUBLIC InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace edgeslam
