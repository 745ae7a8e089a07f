// A configuration read from a file, as the program reads it.
#pragma once

#include <string>

#include "configuration/configuration.h"
#include "unit/files/temporary_folder.h"

namespace edgeslam {

inline Configuration configurationOf(const std::string& text) {
  const TemporaryFolder folder;
  return readConfiguration(folder.write("file.yaml", text));
}

}  // namespace edgeslam
