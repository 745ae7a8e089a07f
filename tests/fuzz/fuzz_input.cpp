#include "fuzz_input.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace edgeslam {
namespace {

bool isControl(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

}  // namespace

void require(bool holds, const std::string& promise) {
  if (holds) return;
  std::fprintf(stderr, "broken promise: %s\n", promise.c_str());
  std::abort();
}

void requireMessage(const std::string& message, const std::string& name) {
  require(!message.empty(), "a message says something");
  require(std::none_of(message.begin(), message.end(), isControl), "a message is one line of text: " + message);
  require(message.find(name) != std::string::npos, "a message names the file " + name + ": " + message);
}

MemoryFolder::MemoryFolder() {
  const bool has_memory = std::filesystem::is_directory("/dev/shm");
  path_ = (has_memory ? "/dev/shm" : std::filesystem::temp_directory_path().string()) + "/edgeslam_fuzz.XXXXXX";
  require(::mkdtemp(path_.data()) != nullptr, "a folder in memory can be made");
}

MemoryFolder::~MemoryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string MemoryFolder::write(const std::string& name, std::string_view content) const {
  const std::string path = path_ + "/" + name;
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  if (!file) {
    std::filesystem::create_directories(std::filesystem::path(path).parent_path());
    file.open(path, std::ios::binary | std::ios::trunc);
  }
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  file.close();
  require(file.good(), "files can be written to memory");
  return path;
}

std::vector<std::string_view> splitFiles(const std::uint8_t* data, std::size_t size, std::size_t count) {
  constexpr std::string_view separator = "====\n";
  std::string_view rest(reinterpret_cast<const char*>(data), size);
  std::vector<std::string_view> files;
  while (files.size() + 1 < count) {
    const std::size_t end = rest.find(separator);
    files.push_back(rest.substr(0, end));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + separator.size());
  }
  files.push_back(rest);
  return files;
}

}  // namespace edgeslam
