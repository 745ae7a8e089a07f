#include "app/output_file.h"

#include <filesystem>

#include "edgeslam/input_error.h"

namespace edgeslam {

void refuseToReplace(const std::string& path, bool force) {
  std::error_code error;
  if (!force && std::filesystem::exists(path, error)) {
    throw InputError(path + ": is there already; give another --output, or --force to replace it");
  }
}

}  // namespace edgeslam
