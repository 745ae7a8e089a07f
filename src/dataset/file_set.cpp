#include "dataset/file_set.h"

#include <filesystem>
#include <system_error>

#include "dataset/atomic_file.h"
#include "edgeslam/input_error.h"

namespace edgeslam {
namespace {

namespace fs = std::filesystem;

constexpr const char* temporary_suffix = ".partial";

// The outermost folder that has to be made, or an empty path.
fs::path firstMissing(const fs::path& folder) {
  fs::path missing;
  std::error_code ignored;
  for (fs::path path = folder; !path.empty() && !fs::exists(path, ignored); path = path.parent_path()) missing = path;
  return missing;
}

fs::path temporary(const fs::path& folder, const FileContent& file) { return folder / (file.name + temporary_suffix); }

void writeAndRename(const fs::path& folder, const std::vector<FileContent>& files) {
  for (const FileContent& file : files) {
    std::error_code ignored;
    if (fs::is_directory(folder / file.name, ignored)) {
      throw InputError((folder / file.name).string() + ": a folder stands where this file is to be written");
    }
    writeFileAtomically(temporary(folder, file).string(), file.content);
  }
  for (const FileContent& file : files) {
    std::error_code error;
    fs::rename(temporary(folder, file), folder / file.name, error);
    if (error) throw InputError((folder / file.name).string() + ": cannot be written: " + error.message());
  }
}

}  // namespace

void writeFileSet(const std::string& folder_name, const std::vector<FileContent>& files) {
  const fs::path folder = fs::path(folder_name.empty() ? "." : folder_name);
  const fs::path made = firstMissing(folder);
  std::error_code ignored;
  try {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw InputError(folder.string() + ": the output folder cannot be made: " + error.message());
    writeAndRename(folder, files);
  } catch (const InputError&) {
    for (const FileContent& file : files) fs::remove(temporary(folder, file), ignored);
    if (!made.empty()) fs::remove_all(made, ignored);
    throw;
  }
}

}  // namespace edgeslam
