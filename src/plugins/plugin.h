// Libraries of the program's own that are loaded where they are wanted: a robot that does without one needs nothing of
// what it is linked with.
#pragma once

#include <string>
#include <vector>

namespace edgeslam {

// Where they may be: beside the program as it is built, and where their packages put them.
std::vector<std::string> pluginFolders();

struct OpenedPlugin {
  void* function = nullptr;  // to be cast; null where it cannot be had
  std::string problem;       // then, in one line
};

// The function of that name (extern "C") in the first of these folders that has the library; by its whole path, as the
// search path of the system's libraries does not count. The library stays loaded.
OpenedPlugin openPlugin(const std::string& library, const char* function,
                        const std::vector<std::string>& folders = pluginFolders());

}  // namespace edgeslam
