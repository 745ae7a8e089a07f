#include "files/file_set.h"

#include <filesystem>
#include <system_error>

#include "edgeslam/input_error.h"
#include "files/atomic_file.h"

namespace edgeslam {
namespace {

namespace fs = std::filesystem;

// The folders that have to be made, the innermost first.
std::vector<fs::path> missingFolders(const fs::path& folder) {
  std::vector<fs::path> missing;
  std::error_code ignored;
  for (fs::path path = folder; !path.empty() && !fs::exists(path, ignored); path = path.parent_path()) {
    missing.push_back(path);
  }
  return missing;
}

void writeAndRename(const fs::path& folder, const std::vector<FileContent>& files) {
  std::vector<PendingFile> pending;
  for (const FileContent& file : files) {
    const std::string path = (folder / file.name).string();
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) {
      throw InputError(path + ": a folder stands where this file is to be written");
    }
    pending.emplace_back(path, file.content);
  }
  for (PendingFile& file : pending) file.takePlace();
}

}  // namespace

void writeFileSet(const std::string& folder_name, const std::vector<FileContent>& files) {
  const fs::path folder = fs::path(folder_name.empty() ? "." : folder_name);
  const std::vector<fs::path> made = missingFolders(folder);
  try {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw InputError(folder.string() + ": the output folder cannot be made: " + error.message());
    writeAndRename(folder, files);
  } catch (const InputError&) {
    std::error_code ignored;
    if (!made.empty()) fs::remove_all(made.back(), ignored);
    throw;
  }
  syncFolder(folder.string());
  for (const fs::path& path : made) syncFolder(path.parent_path().string());
}

}  // namespace edgeslam
