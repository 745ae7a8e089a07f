#include "system/faults/confirmed_disk.h"

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

namespace edgeslam {
namespace {

namespace fs = std::filesystem;

struct Disk {
  std::map<std::string, std::uintmax_t> synced_bytes;  // of files that were made
  std::set<std::string> names_not_synced;
};

void renameOn(Disk& disk, const std::string& from, const std::string& to) {
  const auto bytes = disk.synced_bytes.find(from);
  if (bytes != disk.synced_bytes.end()) {
    disk.synced_bytes[to] = bytes->second;
    disk.synced_bytes.erase(from);
  }
  disk.names_not_synced.erase(from);
  disk.names_not_synced.insert(to);
}

void syncOn(Disk& disk, const std::string& path, std::uintmax_t bytes) {
  if (!fs::is_directory(path)) {
    disk.synced_bytes[path] = bytes;
    return;
  }
  for (auto name = disk.names_not_synced.begin(); name != disk.names_not_synced.end();) {
    name = fs::path(*name).parent_path() == path ? disk.names_not_synced.erase(name) : std::next(name);
  }
}

void syncAllOn(Disk& disk, const std::string& folder) {
  disk.names_not_synced.clear();
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) disk.synced_bytes[entry.path().string()] = entry.file_size();
  }
}

Disk diskAfter(const std::string& log, const std::string& folder) {
  Disk disk;
  std::ifstream file(log);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string number, call, path, more;
    words >> number >> call >> path >> more;
    if (call == "open") {
      disk.synced_bytes[path] = 0;
      disk.names_not_synced.insert(path);
    } else if (call == "mkdir") {
      disk.names_not_synced.insert(path);
    } else if (call == "rename") {
      renameOn(disk, path, more);
    } else if (call == "fsync") {
      syncOn(disk, path, std::stoull(more));
    } else if (call == "syncfs") {
      syncAllOn(disk, folder);
    }
  }
  return disk;
}

}  // namespace

void lose(Loss loss, const std::string& folder, const std::string& log, const std::string& before) {
  if (loss == Loss::nothing) return;
  const Disk disk = diskAfter(log, folder);
  for (const auto& [path, bytes] : disk.synced_bytes) {
    if (fs::is_regular_file(path) && fs::file_size(path) > bytes) fs::resize_file(path, bytes);
  }
  if (loss == Loss::content) return;
  for (const std::string& path : disk.names_not_synced) {
    fs::remove_all(path);
    const fs::path earlier = fs::path(before) / fs::relative(path, folder);
    if (fs::exists(earlier)) fs::copy(earlier, path, fs::copy_options::recursive);
  }
}

}  // namespace edgeslam
