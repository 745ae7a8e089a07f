// A folder that lives as long as a test.
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "edgeslam/input_error.h"

namespace edgeslam {

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "edgeslam-test-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    folder_ = name;
  }
  ~TemporaryFolder() {
    std::error_code error;
    std::filesystem::remove_all(folder_, error);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string path(const std::string& name = "") const { return name.empty() ? folder_ : folder_ + "/" + name; }

  // Makes the folders on the way, too. Returns the file's path.
  std::string write(const std::string& name, const std::string& content) const {
    const std::filesystem::path file = path(name);
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << content;
    return file.string();
  }

 private:
  std::string folder_;
};

inline std::string fileContent(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// Expects the statement to throw InputError with each of the texts in its message.
template <typename Statement, typename... Texts>
void expectInputError(const Statement& statement, const Texts&... texts) {
  try {
    statement();
  } catch (const InputError& error) {
    const std::string message = error.what();
    for (const std::string& text : {std::string(texts)...}) {
      EXPECT_NE(message.find(text), std::string::npos) << "no '" << text << "' in: " << message;
    }
    return;
  }
  ADD_FAILURE() << "no InputError";
}

}  // namespace edgeslam
