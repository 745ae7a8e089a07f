#include "service/recording_folder.h"

#include <array>
#include <ctime>
#include <filesystem>

#include "edgeslam/input_error.h"

namespace edgeslam {

std::string nextRecordingFolder(const std::string& parent) {
  if (parent.empty()) throw InputError("no folder is configured for recordings (recording.folder)");
  std::error_code error;
  std::filesystem::create_directories(parent, error);
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, 32> stamp{};
  std::strftime(stamp.data(), stamp.size(), "%Y%m%dT%H%M%SZ", &utc);
  const std::string name = (std::filesystem::path(parent) / stamp.data()).string();
  std::string folder = name;
  for (int number = 2; std::filesystem::exists(folder, error); ++number) folder = name + "-" + std::to_string(number);
  return folder;
}

}  // namespace edgeslam
