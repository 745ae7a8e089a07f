#include "plugins/plugin.h"

#include <dlfcn.h>

#include <filesystem>

namespace edgeslam {
namespace {

std::string pathOfLibrary(const std::string& library, const std::vector<std::string>& folders) {
  for (const std::string& folder : folders) {
    const std::filesystem::path path = std::filesystem::path(folder) / library;
    std::error_code error;
    if (std::filesystem::exists(path, error)) return path.string();
  }
  return "";
}

}  // namespace

std::vector<std::string> pluginFolders() {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return {};
  const std::filesystem::path folder = program.parent_path();
  return {folder.string(), (folder / EDGESLAM_WAY_TO_LIBRARIES).lexically_normal().string()};
}

OpenedPlugin openPlugin(const std::string& library, const char* function, const std::vector<std::string>& folders) {
  const std::string path = pathOfLibrary(library, folders);
  if (path.empty()) return {nullptr, library + " is not there"};
  void* loaded = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* found = loaded ? dlsym(loaded, function) : nullptr;
  if (found) return {found, ""};
  const char* why = dlerror();  // NOLINT(concurrency-mt-unsafe): glibc's is of the thread
  return {nullptr, why ? why : path};
}

}  // namespace edgeslam
